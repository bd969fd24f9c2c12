#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "waymark/core/aligned_array.hpp"
#include "waymark/fastslam/particle_blocks.hpp"

namespace waymark::fastslam {

/// One landmark as one particle sees it: mean and covariance given that particle's path, world frame, m and
/// m^2.
struct LandmarkGaussian {
  double x = 0.0;
  double y = 0.0;
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;
};

/// One landmark as all particles see it: entry i of each column belongs to particle i. Columns are 64-byte
/// aligned.
struct LandmarkColumns {
  double* x = nullptr;
  double* y = nullptr;
  double* xx = nullptr;
  double* xy = nullptr;
  double* yy = nullptr;

  [[nodiscard]] LandmarkGaussian at(std::size_t particle) const {
    return {x[particle], y[particle], xx[particle], xy[particle], yy[particle]};
  }
};

/// The maps of all particles, landmark by landmark. Resampling copies no landmark: it only notes which place
/// of the old generation each particle's map now stands in, and a landmark is brought into the present order
/// when it is next touched. The result equals deep copies of the maps bit for bit.
///
/// add() takes memory; nothing else does. Costs for N particles: touch() 5 N copies if the set was resampled
/// since the last touch, else nothing; resample() at most kGenerations N, whatever the size of the map.
class LandmarkStore {
 public:
  /// `blocks` must outlive the store.
  explicit LandmarkStore(ParticleBlocks& blocks);

  [[nodiscard]] int size() const { return static_cast<int>(landmarks_.size()); }

  /// Appends a landmark of zeros and returns its index.
  int add();

  /// The landmark in the present order of particles. Valid until the next call of touch(), accept() or add().
  LandmarkColumns touch(int landmark);

  /// Room beside the landmarks, in which a new version of one can be prepared. Valid as long as touch()'s
  /// columns.
  [[nodiscard]] LandmarkColumns draft() { return columns_of(draft_); }

  /// The draft becomes the landmark.
  void accept(int landmark);

  /// Particle i takes over the map of ancestors[i].
  void resample(std::span<const std::int32_t> ancestors);

  /// What touch() would show for one particle, without touching.
  [[nodiscard]] LandmarkGaussian at(int landmark, int particle) const;

 private:
  static constexpr std::size_t kColumns = 5;
  static constexpr std::size_t kGenerations = 16;

  using Buffer = AlignedArray<double>;

  struct Landmark {
    Buffer buffer;
    std::size_t generation;
  };

  /// Landmarks whose columns are in the order that the particles had at one time.
  struct Generation {
    AlignedArray<std::int32_t>
        places;              ///< where particle i's entry stands; not used for the present generation
    int landmarks = 0;       ///< how many are in this order; 0: free for use
    std::int64_t ended = 0;  ///< number of the resampling that ended it
  };

  [[nodiscard]] Buffer make_buffer() const { return Buffer(kColumns * stride_); }
  [[nodiscard]] LandmarkColumns columns_of(Buffer& buffer) const;
  void move_to_present(Landmark& landmark);
  void end_present_generation(std::span<const std::int32_t> ancestors);
  [[nodiscard]] std::size_t free_generation() const;
  void empty_oldest_generation();

  ParticleBlocks& blocks_;
  std::size_t stride_;
  std::vector<Landmark> landmarks_;
  std::vector<Generation> generations_;
  AlignedArray<std::int32_t> composed_;
  Buffer draft_;
  std::size_t present_ = 0;
  std::int64_t resamplings_ = 0;
};

}  // namespace waymark::fastslam
