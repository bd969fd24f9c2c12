#include "waymark/slam/camera_front_end.hpp"

#include <algorithm>

namespace waymark {

CameraFrontEnd::CameraFrontEnd(PixelSlam& filter, const vision::TrackerOptions& options,
                               const vision::SearchOptions& search, const Camera& camera, int threads)
    : filter_(filter), camera_(camera), tracker_(options, search, camera, threads) {}

bool CameraFrontEnd::fits(const ImageView& image) const {
  return image.width_px == camera_.width_px() && image.height_px == camera_.height_px();
}

const Correction& CameraFrontEnd::see(const ImageView& image) {
  innovations_.clear();
  const auto expectations = filter_.expect();
  tracker_.begin(image, filter_.pose().T_world_robot, expectations);
  const vision::Sightings landmarks = tracker_.match();
  // Where nothing at all was found the picture is to blame, not the landmarks: a covered lens, the light out.
  if (!landmarks.found.empty()) filter_.missed(landmarks.missed);
  correct(landmarks.found);
  const vision::Sightings others = tracker_.finish();
  filter_.missed(others.missed);
  const Correction& last = correct(others.found);
  tracker_.learn(last);
  correction_ = {innovations_, last.removed};
  return correction_;
}

const Correction& CameraFrontEnd::correct(std::span<const Observation> found) {
  const Correction& correction = filter_.correct(found);
  innovations_.insert(innovations_.end(), correction.innovations.begin(), correction.innovations.end());
  return correction;
}

std::vector<FunctionBlocks::Row> CameraFrontEnd::blocks() const {
  std::vector<FunctionBlocks::Row> rows;
  for (const FunctionBlocks* table : {&filter_.blocks(), &tracker_.blocks()})
    rows.insert(rows.end(), table->rows().begin(), table->rows().end());
  std::ranges::sort(rows, {}, &FunctionBlocks::Row::name);
  return rows;
}

}  // namespace waymark
