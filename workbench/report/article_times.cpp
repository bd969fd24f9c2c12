#include "workbench/report/article_times.hpp"

#include <algorithm>
#include <array>

#include "workbench/run/article_methods.hpp"

namespace waymark {
namespace {

// As printed; means of both columns, so that their product is not the third.
constexpr std::array kTimes{
    // Vincke Table 2
    ArticleTime{"FB1", 93.0, 1.0, 93.0},      ArticleTime{"FB2", 3400.0, 1.0, 3400.0},
    ArticleTime{"FB3", 9.0, 19.0, 180.0},     ArticleTime{"FB4", 11.29, 233.0, 2630.0},
    ArticleTime{"FB5", 14.5, 4.5, 66.0},      ArticleTime{"FB6", 88845.0, 0.8, 70568.0},
    ArticleTime{"FB7", 11.29, 123.0, 1388.0}, ArticleTime{"FB8", 638.0, 4.0, 2586.0},
    ArticleTime{"FB9", 103.0, 0.18, 18.0},
};

}  // namespace

bool is_article_system(const Config& config) {
  return config.observe == Observe::kPixel && uses_article_methods(config);
}

std::optional<ArticleTime> article_time(std::string_view block_name) {
  const auto number = block_name.substr(0, block_name.find(' '));
  const auto found = std::ranges::find(kTimes, number, &ArticleTime::block);
  return found == kTimes.end() ? std::nullopt : std::optional(*found);
}

}  // namespace waymark
