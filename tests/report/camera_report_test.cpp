#include "workbench/report/camera_report.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "support/browser.hpp"

namespace waymark {
namespace {

using calibrate::BoardCorners;
using calibrate::BoardView;
using calibrate::Fate;

/// Views of a board that is turned about one axis and then the other, exact but for one corner; one image
/// without a board, and two frames that nobody looks at.
CameraReport sample_camera() {
  const calibrate::Board board{.corners = {5, 4}, .square_m = 0.04};
  const Camera camera({.width_px = 320, .height_px = 240});
  std::vector<BoardView> views;
  for (int i = 0; i < 8; ++i) {
    const double turn_rad = 0.15 * (i - 3.5);
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = Eigen::AngleAxisd(turn_rad, i % 2 == 0 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY())
                     .toRotationMatrix();
    T.translation() = Eigen::Vector3d(-0.08 + 0.02 * (i - 4), -0.06, 0.4);
    BoardView view{.name = "<photo> " + std::to_string(i),
                   .size = {320, 240},
                   .small = GreyImage(320, 240, 120),
                   .edge_px = 1.5};
    for (int corner = 0; corner < board.size(); ++corner) {
      const Eigen::Vector2d m = board.corner_m(corner);
      view.corners.push_back({corner, camera.project(T * Eigen::Vector3d(m.x(), m.y(), 0.0))->pixel});
    }
    view.corners[static_cast<std::size_t>(i)].pixel.x() += 0.1;
    views.push_back(std::move(view));
  }
  views.push_back({.name = "empty", .small = GreyImage(320, 240), .fate = Fate::kNoBoard, .why = "no board"});
  views.push_back({.name = "frame 7", .fate = Fate::kNoBoard});
  views.push_back({.name = "frame 9", .fate = Fate::kAlike});
  return {"waymark calibrate camera", *calibrate::calibrate_camera(board, std::move(views))};
}

TEST(CameraReport, IsOneFileWithoutAddresses) {
  const std::string html = render_camera_report(sample_camera());
  for (const char* load : {"http://", "https://", "src=\"", "@import", "url(", "fetch(", "XMLHttpRequest"})
    EXPECT_EQ(html.find(load), std::string::npos) << load;
}

TEST(CameraReport, SaysWhereItCannotBeWritten) {
  const auto written = write_camera_report(sample_camera(), "/nowhere/report.html");
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().message.find("/nowhere/report.html"), std::string::npos);
}

TEST(CameraReport, JsonHasEveryViewAndWhyTheSetIsWeak) {
  const auto json = nlohmann::json::parse(camera_json_text(sample_camera().calibration));
  EXPECT_EQ(json["views"].size(), 11U);
  EXPECT_EQ(json["views"][0]["verdict"], "used");
  EXPECT_EQ(json["views"][8]["why"], "no board");
  EXPECT_TRUE(json["weak"]);  // 8 views
  EXPECT_NE(json["weaknesses"][0]["what"].get<std::string>().find("only 8 views"), std::string::npos);
  EXPECT_EQ(json["intrinsics"][0]["name"], "fu_px");
  EXPECT_NEAR(json["intrinsics"][0]["value"].get<double>(), 277.0, 5.0);
}

#ifdef WAYMARK_CHROMIUM

TEST(CameraPage, ShowsTheVerdictAndEveryImage) {
  const test::Page page = test::open_in_browser(render_camera_report(sample_camera()));
  EXPECT_EQ(page.console, "");
  EXPECT_EQ(page.title, "used to the end");
  EXPECT_EQ(test::count(page.body, "<figure"), 9U);
  EXPECT_EQ(test::count(page.body, "class=\"corner\""), 8U * 20U);
  EXPECT_EQ(test::count(page.body, "<rect class=\"cell\""), 16U * 12U);
  for (const char* text :
       {"Weak", "only 8 views", "&lt;photo&gt; 3", "no board", "2 frames without the board"})
    EXPECT_NE(page.body.find(text), std::string::npos) << text;
}

#else

TEST(CameraPage, ShowsTheVerdictAndEveryImage) { GTEST_SKIP() << "no chromium on this machine"; }

#endif

}  // namespace
}  // namespace waymark
