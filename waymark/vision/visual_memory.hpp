#pragma once

#include <cstddef>
#include <vector>

#include "waymark/core/map_state.hpp"
#include "waymark/core/observation.hpp"
#include "waymark/models/camera.hpp"
#include "waymark/vision/patch.hpp"

namespace waymark::vision {

/// What a landmark looks like.
struct Appearance {
  Pose2 T_world_robot;   ///< where the robot was believed to be when the patch was cut,
  CameraPose seen_from;  ///< and the camera
  WarpedPatch patch;
};

/// The appearances of all landmarks that are searched for. Allocates only when it holds more than ever
/// before, and more than kRoom.
class VisualMemory {
 public:
  static constexpr std::size_t kRoom = 128;

  explicit VisualMemory(int patch_px);

  /// Null where nothing is known. Valid until the next remember(), even if forgotten meanwhile.
  [[nodiscard]] Appearance* find(LandmarkId id);
  /// In place of what was known under this identity.
  void remember(LandmarkId id, const ReferencePatch& reference, const Pose2& T_world_robot,
                const CameraPose& seen_from);
  void forget(LandmarkId id);
  [[nodiscard]] std::size_t size() const { return entries_.size(); }
  /// All of it, in the order of identities. Allocates.
  [[nodiscard]] std::vector<LandmarkPatch> patches() const;

 private:
  struct Entry {
    LandmarkId id;
    std::size_t slot;
  };
  [[nodiscard]] std::vector<Entry>::iterator place_of(LandmarkId id);
  [[nodiscard]] std::size_t store(const Appearance& appearance);

  int patch_px_;
  std::vector<Entry> entries_;  ///< in the order of identities
  std::vector<std::size_t> free_;
  std::vector<Appearance> slots_;
};

}  // namespace waymark::vision
