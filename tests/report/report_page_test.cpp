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
  std::string dom;
  std::string console;
};

Page open_in_browser(const ReportData& data) {
  const ScratchFolder scratch;
  std::string html = render_report(data);
  html.replace(html.rfind("</body>"), 7, kUser);
  const auto file = scratch.path / "report.html";
  const auto log = scratch.path / "log";
  EXPECT_TRUE(write_file(file, html));
  const std::string command =
      "timeout 120 '" WAYMARK_CHROMIUM
      "' --headless --no-sandbox --disable-gpu --no-first-run --disable-background-networking "
      "--disable-component-update --disable-sync --window-size=1300,1000 "
      "--virtual-time-budget=3000 --enable-logging=stderr --user-data-dir='" +
      (scratch.path / "profile").string() + "' --dump-dom 'file://" + file.string() + "' 2>'" + log.string() +
      "'";
  Page page;
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  std::array<char, 65536> buffer;
  while (const std::size_t n = std::fread(buffer.data(), 1, buffer.size(), pipe.get()))
    page.dom.append(buffer.data(), n);
  const auto text = read_file(log);
  for (std::size_t at = 0; text && at < text->size();) {
    const std::size_t end = std::min(text->find('\n', at), text->size());
    const std::string line = text->substr(at, end - at);
    if (line.find("CONSOLE") != std::string::npos) page.console += line + "\n";
    at = end + 1;
  }
  return page;
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
  EXPECT_NE(page.dom.find("<title>used to the end</title>"), std::string::npos);
  EXPECT_EQ(count(page.dom, kUplot), 8U);  // position; x, y, heading, NEES; innovations, histogram; steps
  EXPECT_EQ(count(page.dom, "class=\"map-frame\""), 1U);
  for (const char* text : {"Runs compared", "Function blocks", "position_rmse_m",
                           "3 observations came before", "Run it again"}) {
    EXPECT_NE(page.dom.find(text), std::string::npos) << text;
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
  EXPECT_EQ(count(page.dom, kUplot), 3U);
  EXPECT_EQ(page.dom.find("Errors over time"), std::string::npos);
  EXPECT_EQ(page.dom.find("Runs compared"), std::string::npos);
}

TEST(ReportPage, OpensWithoutAnything) {
  ReportData data;
  data.runs.resize(1);
  const Page page = open_in_browser(data);
  EXPECT_EQ(page.console, "");
  EXPECT_NE(page.dom.find("nothing to show"), std::string::npos);
  EXPECT_EQ(count(page.dom, kUplot), 0U);
}

#else

TEST(ReportPage, DrawsEverythingAndAnswers) { GTEST_SKIP() << "no chromium on this machine"; }

#endif

}  // namespace
}  // namespace waymark
