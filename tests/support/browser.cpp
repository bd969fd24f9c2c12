#include "support/browser.hpp"

#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string_view>

#include <gtest/gtest.h>

#include "workbench/logs/files.hpp"

#ifdef WAYMARK_CHROMIUM

namespace waymark::test {
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

}  // namespace

Page open_in_browser(std::string html) {
  const ScratchFolder scratch;
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

}  // namespace waymark::test

#endif
