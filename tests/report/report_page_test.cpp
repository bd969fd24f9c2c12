// The page in a browser: it draws, it answers, and it reports no error on the console.

#include "waymark/report/report_page.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "waymark/io/files.hpp"

#include "sample_report.hpp"

namespace waymark {
namespace {

// Uses everything that can be used, then says in the page's title that it got there.
constexpr std::string_view kUser = R"html(<script>
addEventListener("load", () => setTimeout(() => {
  for (const button of document.querySelectorAll("button:not([title='Save as PNG'])")) {
    if (button.textContent !== "Copy") button.click();
  }
  const map = document.querySelector(".map-frame canvas");
  if (map) {
    const box = map.getBoundingClientRect();
    const at = (type, x, y) => map.dispatchEvent(new PointerEvent(type,
        {clientX: box.left + x, clientY: box.top + y, pointerType: "mouse", bubbles: true}));
    map.dispatchEvent(new MouseEvent("dblclick"));
    for (let x = 0; x < box.width; x += 7) at("pointermove", x, box.height / 2);
    map.dispatchEvent(new WheelEvent("wheel", {deltaY: -200, cancelable: true}));
    map.dispatchEvent(new KeyboardEvent("keydown", {key: "+"}));
  }
  for (const over of document.querySelectorAll(".u-over")) {
    const box = over.getBoundingClientRect();
    over.dispatchEvent(new MouseEvent("mousemove",
        {clientX: box.left + 50, clientY: box.top + 20, bubbles: true}));
  }
  for (const name of ["beforeprint", "afterprint"]) dispatchEvent(new Event(name));
  setTimeout(() => { document.title = "used to the end"; }, 100);
}, 300));
</script></body>)html";

#ifdef WAYMARK_CHROMIUM

// A folder that goes away with the test.
struct ScratchFolder {
  ScratchFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "waymark-page-XXXXXX").string();
    if (mkdtemp(name.data()) != nullptr) path = name;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  std::filesystem::path path;
};

struct Page {
  std::string title;
  std::string body;     // what the script made: the main element
  std::string console;  // lines that a script or the browser wrote
};

std::string between(const std::string& text, const std::string& begin, const std::string& end) {
  const auto at = text.find(begin);
  if (at == std::string::npos) return "";
  return text.substr(at + begin.size(), text.find(end, at) - at - begin.size());
}

std::string output_of(const std::string& command) {
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  std::string text;
  std::array<char, 65536> buffer;
  while (const std::size_t n = std::fread(buffer.data(), 1, buffer.size(), pipe.get()))
    text.append(buffer.data(), n);
  return text;
}

Page open_in_browser(const ReportData& data) {
  const ScratchFolder scratch;
  std::string html = render_report(data);
  html.replace(html.rfind("</body>"), 7, kUser);
  const std::string file = (scratch.path / "report.html").string();
  const std::string log = (scratch.path / "log").string();
  EXPECT_TRUE(write_file(file, html));
  const std::string dom = output_of(
      "timeout 120 '" WAYMARK_CHROMIUM
      "' --headless --no-sandbox --disable-gpu --no-first-run --disable-background-networking "
      "--disable-component-update --disable-sync --window-size=1300,1000 --virtual-time-budget=3000 "
      "--enable-logging=stderr --user-data-dir='" +
      (scratch.path / "profile").string() + "' --dump-dom 'file://" + file + "' 2>'" + log + "'");
  return {between(dom, "<title>", "</title>"), between(dom, "<main", "</main>"),
          output_of("grep CONSOLE '" + log + "'")};
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) ++found;
  return found;
}

constexpr const char* kUplot = "class=\"uplot ";

TEST(ReportPage, DrawsEverythingAndAnswers) {
  const Page page = open_in_browser(sample_report(900));
  EXPECT_EQ(page.console, "");
  EXPECT_EQ(page.title, "used to the end");
  EXPECT_EQ(count(page.body, kUplot), 8U);  // position; x, y, heading, NEES; innovations, histogram; steps
  EXPECT_EQ(count(page.body, "class=\"map-frame\""), 1U);
  for (const char* text : {"Runs compared", "Function blocks", "position_rmse_m",
                           "3 observations came before", "Run it again"}) {
    EXPECT_NE(page.body.find(text), std::string::npos) << text;
  }
}

TEST(ReportPage, LeavesOutWhatARunDoesNotHave) {
  ReportData data = sample_report(300);
  data.truth = {};
  data.truth_landmarks.clear();
  data.dead_reckoning = {};
  data.runs.resize(1);
  data.runs[0].errors = {};
  data.runs[0].alignment.reset();
  const Page page = open_in_browser(data);
  EXPECT_EQ(page.console, "");
  EXPECT_EQ(count(page.body, kUplot), 3U);
  EXPECT_EQ(page.body.find("Errors over time"), std::string::npos);
  EXPECT_EQ(page.body.find("Runs compared"), std::string::npos);
}

TEST(ReportPage, OpensWithoutAnything) {
  ReportData data;
  data.runs.resize(1);
  const Page page = open_in_browser(data);
  EXPECT_EQ(page.console, "");
  EXPECT_NE(page.body.find("nothing to show"), std::string::npos);
  EXPECT_EQ(count(page.body, kUplot), 0U);
}

#else

TEST(ReportPage, DrawsEverythingAndAnswers) { GTEST_SKIP() << "no chromium on this machine"; }

#endif

}  // namespace
}  // namespace waymark
