#include "workbench/calibrate/view.hpp"

#include <gtest/gtest.h>

#include "photographed_board.hpp"

namespace waymark::calibrate {
namespace {

/// Images whose first pixel numbers them.
class NumberedImages final : public ImageSource {
 public:
  NumberedImages(int count, bool is_stream) : count_(count), is_stream_(is_stream) {}

  Result<std::optional<NamedImage>> next() override {
    if (next_ == count_) return std::optional<NamedImage>{};
    GreyImage image(640, 480, 100);
    image(0, 0) = static_cast<std::uint8_t>(next_);
    return std::optional(NamedImage{std::to_string(next_++), std::move(image)});
  }
  [[nodiscard]] double progress() const override { return static_cast<double>(next_) / count_; }
  [[nodiscard]] bool is_stream() const override { return is_stream_; }

 private:
  int count_;
  bool is_stream_;
  int next_ = 0;
};

/// Knows what every image shows.
class KnowingFinder final : public BoardFinder {
 public:
  explicit KnowingFinder(std::vector<BoardCorners> corners) : corners_(std::move(corners)) {}
  std::optional<BoardCorners> find(const ImageView& image) override {
    const BoardCorners& found = corners_[image(0, 0)];
    return found.empty() ? std::nullopt : std::optional(found);
  }

 private:
  std::vector<BoardCorners> corners_;
};

/// A view, the same moved by 3 px, another view, no board, and too little of a board.
std::vector<BoardCorners> sights() {
  const auto views = test::photograph(test::chessboard(), test::true_camera(), 2, 0.0, 8);
  BoardCorners moved = views[0];
  for (BoardCorner& corner : moved) corner.pixel.x() += 3.0;
  return {views[0], moved, views[1], {}, {views[0].begin(), views[0].begin() + 5}};
}

std::vector<Fate> fates(bool is_stream) {
  NumberedImages images(5, is_stream);
  KnowingFinder finder(sights());
  const auto views = collect_views(images, test::chessboard(), finder);
  std::vector<Fate> all;
  for (const BoardView& view : *views) all.push_back(view.fate);
  return all;
}

TEST(BoardView, FramesLikeOneBeforeArePassedOver) {
  using enum Fate;
  EXPECT_EQ(fates(true), (std::vector{kUsed, kAlike, kUsed, kNoBoard, kFewCorners}));
  EXPECT_EQ(fates(false), (std::vector{kUsed, kUsed, kUsed, kNoBoard, kFewCorners}));
}

TEST(BoardView, ImagesAreKeptSmall) {
  NumberedImages images(1, false);
  KnowingFinder finder(sights());
  const auto views = collect_views(images, test::chessboard(), finder);
  ASSERT_TRUE(views);
  const BoardView& view = views->front();
  EXPECT_EQ(view.reduction, 2);
  EXPECT_EQ(view.small.width_px(), 320);
  EXPECT_EQ(view.small(100, 100), 100);
}

TEST(BoardView, UnreadableImagesSayWhy) {
  KnowingFinder finder({});
  const BoardView view = measure_view({"x.png", Error{"x.png: damaged"}}, test::chessboard(), finder);
  EXPECT_EQ(view.fate, Fate::kUnreadable);
  EXPECT_EQ(view.why, "x.png: damaged");
}

TEST(BoardView, CanBeStopped) {
  NumberedImages images(5, false);
  KnowingFinder finder(sights());
  const auto views = collect_views(images, test::chessboard(), finder, [](double) { return false; });
  ASSERT_FALSE(views);
  EXPECT_EQ(views.error().kind, Error::Kind::kFailed);
}

}  // namespace
}  // namespace waymark::calibrate
