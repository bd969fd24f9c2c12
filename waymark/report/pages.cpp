#include "waymark/report/pages.hpp"

namespace waymark {

std::string safe_in_script(std::string_view json) {
  std::string safe;
  safe.reserve(json.size() + 64);
  for (const char c : json) {
    if (c == '<')
      safe += "\\u003c";
    else
      safe += c;
  }
  return safe;
}

std::string fill_page(std::string_view page, std::string_view json) {
  std::string html(page);
  return html.replace(html.find(kPageDataMark), kPageDataMark.size(), safe_in_script(json));
}

}  // namespace waymark
