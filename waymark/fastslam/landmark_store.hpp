#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "waymark/core/aligned_array.hpp"
#include "waymark/fastslam/column_pool.hpp"
#include "waymark/fastslam/landmark_point.hpp"
#include "waymark/fastslam/particle_blocks.hpp"
#include "waymark/kernels/particle_columns.hpp"

namespace waymark::fastslam {

/// The maps of all particles, landmark by landmark. Resampling copies no landmark: it only notes which place
/// of the old generation each particle's map now stands in, and a landmark is brought into the present order
/// when it is next used. The result equals deep copies of the maps bit for bit.
///
/// Costs for N particles: gather() copies a landmark's columns if the set was resampled since the last time,
/// else nothing. resample() at most kGenerations N, whatever the size of the map; when the generations run
/// out, young ones are folded into the present one before old ones, after Bentley and Saxe (1980): a landmark
/// that nobody looks at is moved O(log landmarks) times, not once per so many resamplings. add() may take
/// memory, but none for landmarks that come after others were removed.
class LandmarkStore {
 public:
  /// `blocks` must outlive the store.
  explicit LandmarkStore(ParticleBlocks& blocks);

  [[nodiscard]] int size() const { return static_cast<int>(landmarks_.size()); }

  /// Appends a landmark of such a form and so many hypotheses, positions counted from `origin_m`, and returns
  /// its index. Its columns hold anything. One whose existence is `doubtful` has a column of log-odds too.
  int add(kernels::LandmarkForm form, const Eigen::Vector2d& origin_m, std::size_t modes = 1,
          bool doubtful = false);

  /// Forgets a landmark; the last one takes its index.
  void remove(int landmark);

  /// Brings a landmark into the present order of particles.
  void gather(int landmark);

  /// A gathered landmark, for kernels that count positions from `origin_m`. Valid until it is gathered after
  /// a resampling, or changed.
  [[nodiscard]] kernels::LandmarkView view(int landmark, const Eigen::Vector2d& origin_m) const;

  [[nodiscard]] kernels::LandmarkForm form(int landmark) const { return of(landmark).form; }
  [[nodiscard]] std::size_t modes(int landmark) const { return of(landmark).modes.size(); }

  /// The log-odds that a gathered landmark exists, one per particle (kernels/particle_existence.hpp); null
  /// where that is not in doubt. Valid as a view is.
  [[nodiscard]] float* existence(int landmark) const { return of(landmark).existence; }

  /// Forgets one of several hypotheses of all particles; of the last one the log weights.
  void drop_mode(int landmark, std::size_t mode);

  /// The landmark's two numbers now are (x, y): its anchors are forgotten.
  void become_point(int landmark);

  /// Particle i takes over the map of ancestors[i].
  void resample(std::span<const std::int32_t> ancestors);

  /// What one particle knows of a landmark, without gathering it: hypotheses as one Gaussian of the same
  /// moments.
  [[nodiscard]] PointGaussian at(int landmark, int particle) const;

 private:
  static constexpr std::size_t kGenerations = 16;
  static constexpr std::size_t kColumnsAtOnce = 8;

  struct LandmarkColumns {
    kernels::LandmarkForm form;
    Eigen::Vector2d origin_m;
    std::vector<kernels::LandmarkMode> modes;
    float* anchor_x = nullptr;
    float* anchor_y = nullptr;
    float* existence = nullptr;
    std::size_t generation = 0;
  };

  /// Landmarks whose columns are in the order that the particles had at one time.
  struct Generation {
    AlignedArray<std::int32_t>
        places;              ///< where particle i's entry stands; not used for the present generation
    int landmarks = 0;       ///< how many are in this order; 0: free for use
    std::int64_t ended = 0;  ///< number of the resampling that ended it
  };

  [[nodiscard]] const LandmarkColumns& of(int landmark) const {
    return landmarks_[static_cast<std::size_t>(landmark)];
  }
  [[nodiscard]] LandmarkColumns& of(int landmark) { return landmarks_[static_cast<std::size_t>(landmark)]; }
  [[nodiscard]] std::vector<kernels::LandmarkMode> empty_modes();
  void list_columns(LandmarkColumns& landmark);
  void gather_columns(const std::int32_t* places);
  void move_to_present(LandmarkColumns& landmark);
  void end_present_generation();
  [[nodiscard]] std::size_t free_generation() const;
  [[nodiscard]] std::int64_t first_to_fold() const;
  void fold_young_generations();

  ParticleBlocks& blocks_;
  ColumnPool pool_;
  std::vector<LandmarkColumns> landmarks_;
  std::vector<std::vector<kernels::LandmarkMode>> spare_modes_;  // lists of removed landmarks, empty
  std::vector<Generation> generations_;
  AlignedArray<std::int32_t> ancestors_;
  AlignedArray<std::int32_t> composed_;
  std::vector<float**> columns_;  // of the landmark that is being moved
  std::size_t present_ = 0;
  std::int64_t resamplings_ = 0;
};

}  // namespace waymark::fastslam
