#pragma once

#include <string>
#include <string_view>

namespace waymark {

/// The pages that web/NAME/ is bundled into at build time, with kPageDataMark where their data belong.
[[nodiscard]] std::string_view report_page();
[[nodiscard]] std::string_view sweep_page();
[[nodiscard]] std::string_view tune_page();
[[nodiscard]] std::string_view camera_page();
[[nodiscard]] std::string_view calibration_page();
[[nodiscard]] std::string_view sensor_page();
/// The monitor of a session, which asks its server for what it shows.
[[nodiscard]] std::string_view live_page();

inline constexpr std::string_view kPageDataMark = "<!-- data -->";

/// A page with its data: JSON in which `<` occurs in strings only.
[[nodiscard]] std::string fill_page(std::string_view page, std::string_view json);

/// The same JSON so that it may stand inside an HTML script element: without `<`, which could end it.
[[nodiscard]] std::string safe_in_script(std::string_view json);

}  // namespace waymark
