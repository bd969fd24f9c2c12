#include "workbench/calibrate/view.hpp"

#include <algorithm>
#include <array>
#include <map>

#include "workbench/calibrate/edge_width.hpp"
#include "workbench/calibrate/plane_homography.hpp"

namespace waymark::calibrate {
namespace {

constexpr int kShownWidth_px = 320;
constexpr double kAlike = 0.04;  // of the image's width

/// Means over squares of pixels.
GreyImage reduced(const ImageView& image, int by) {
  GreyImage small(image.width_px / by, image.height_px / by);
  for (int v = 0; v < small.height_px(); ++v)
    for (int u = 0; u < small.width_px(); ++u) {
      int sum = 0;
      for (int y = 0; y < by; ++y)
        for (int x = 0; x < by; ++x) sum += image(u * by + x, v * by + y);
      small(u, v) = static_cast<std::uint8_t>(sum / (by * by));
    }
  return small;
}

/// Nothing: the views have too few corners in common to tell.
bool is_alike(const BoardView& a, const BoardView& b) {
  double distance_px = 0.0;
  std::size_t common = 0;
  auto other = b.corners.begin();
  for (const auto& [index, pixel] : a.corners) {
    other = std::find_if(other, b.corners.end(), [&](const BoardCorner& c) { return c.index >= index; });
    if (other == b.corners.end()) break;
    if (other->index != index) continue;
    distance_px += (pixel - other->pixel).norm();
    ++common;
  }
  return a.size == b.size && common >= kMinCorners &&
         distance_px < kAlike * a.size.width_px * static_cast<double>(common);
}

void compare_with(const std::vector<BoardView>& others, BoardView& view) {
  if (view.fate != Fate::kUsed) return;
  const auto like = std::ranges::find_if(
      others, [&](const BoardView& other) { return other.fate == Fate::kUsed && is_alike(view, other); });
  if (like == others.end()) return;
  view.fate = Fate::kAlike;
  view.why = "the board is where it is in " + like->name;
}

}  // namespace

const char* name_of(Fate fate) {
  static constexpr std::array kNames{"used",        "unreadable", "other size", "no board",
                                     "few corners", "alike",      "blurred",    "outlier"};
  return kNames[static_cast<std::size_t>(fate)];
}

BoardView measure_view(const NamedImage& frame, const Board& board, BoardFinder& finder) {
  BoardView view{.name = frame.name};
  if (!frame.pixels) {
    view.fate = Fate::kUnreadable;
    view.why = frame.pixels.error().message;
    return view;
  }
  const GreyImage& pixels = *frame.pixels;
  view.size = {pixels.width_px(), pixels.height_px()};
  view.reduction = std::max(1, (view.size.width_px + kShownWidth_px - 1) / kShownWidth_px);
  view.small = reduced(pixels, view.reduction);
  view.corners = finder.find(pixels).value_or(BoardCorners{});
  if (view.corners.empty()) {
    view.fate = Fate::kNoBoard;
    view.why = "no " + describe(board);
  } else if (view.corners.size() < kMinCorners || !plane_homography(board, view.corners)) {
    view.fate = Fate::kFewCorners;
    view.why = "too few corners of the board, or all of them on a line";
  }
  view.edge_px = edge_width_px(pixels, board, view.corners);
  return view;
}

Result<std::vector<BoardView>> collect_views(ImageSource& images, const Board& board, BoardFinder& finder,
                                             const std::function<bool(double)>& keep_going) {
  std::vector<BoardView> views;
  while (true) {
    auto frame = images.next();
    if (!frame) return frame.error();
    if (!*frame) return views;
    BoardView view = measure_view(**frame, board, finder);
    if (images.is_stream()) {
      compare_with(views, view);
      if (view.fate != Fate::kUsed) view.small = GreyImage();
    }
    views.push_back(std::move(view));
    if (keep_going && !keep_going(images.progress()))
      return Error{"stopped before all images were looked at", Error::Kind::kFailed};
  }
}

std::optional<GridSize> guess_chessboard(ImageSource& images) {
  constexpr int kLookedAt = 20;
  constexpr GridSize kSmallest{3, 3};  // many things look like it
  std::map<std::pair<int, int>, int> votes;
  for (int i = 0; i < kLookedAt; ++i) {
    const auto frame = images.next();
    if (!frame || !*frame) break;
    const auto& pixels = (**frame).pixels;
    const auto grid = pixels ? guess_chessboard(*pixels) : std::nullopt;
    if (grid && *grid != kSmallest) ++votes[{grid->columns, grid->rows}];
  }
  if (votes.empty()) return std::nullopt;
  // Of two that are as frequent, the larger: parts of a board are found more easily than more than it.
  const auto best = std::ranges::max_element(votes, {}, [](const auto& vote) {
    return std::pair(vote.second, vote.first.first * vote.first.second);
  });
  return best->second > 1 ? std::optional(GridSize{best->first.first, best->first.second}) : std::nullopt;
}

}  // namespace waymark::calibrate
