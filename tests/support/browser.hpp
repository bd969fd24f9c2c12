#pragma once

#include <cstddef>
#include <string>

namespace waymark::test {

// What a browser made of a page.
struct Page {
  std::string title;
  std::string body;     // what the script made: the main element
  std::string console;  // lines that a script or the browser wrote
};

// Opens a page, uses everything on it that can be used, and then sets its title to "used to the end". Only
// where WAYMARK_CHROMIUM is defined.
Page open_in_browser(std::string html);

std::size_t count(const std::string& text, const std::string& part);

// Stands once in every chart.
inline constexpr const char* kUplot = "class=\"uplot ";

}  // namespace waymark::test
