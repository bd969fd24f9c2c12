#pragma once

#include <optional>
#include <span>
#include <vector>

#include "waymark/core/expectation.hpp"
#include "waymark/core/filter.hpp"
#include "waymark/core/function_blocks.hpp"
#include "waymark/ekf/agreement.hpp"
#include "waymark/ekf/depth_particles.hpp"
#include "waymark/ekf/map_management.hpp"
#include "waymark/ekf/pixel_map.hpp"
#include "waymark/ekf/pixel_slam_options.hpp"
#include "waymark/models/camera.hpp"

namespace waymark {

/// EKF-SLAM over the pixels of points in space (Vincke et al. 2012 \cite vincke2012). It sees no image: who
/// looks for its landmarks asks expect() where to look, and reports what it found (correct()) and what not
/// (missed()). A pixel with an identity that is not known begins a candidate, whose distance later pixels
/// find out.
class PixelSlam final : public Filter {
 public:
  /// `threads` share updates of large maps; the result does not depend on them. Takes all its memory here.
  /// One object must not be used by two threads at once; two objects may.
  PixelSlam(const PixelSlamOptions& options, const CameraOptions& camera, int threads = 1);

  /// Goes on from a saved map of points; only before anything was predicted or seen. Changes nothing where it
  /// does not fit. A landmark without patch is taken to have been seen from where the map ends.
  [[nodiscard]] Result<void> load(const MapState& map);

  void predict(const Motion& motion) override;
  /// Landmarks and candidates that should be in the picture, at the present pose. Begins a picture: call it
  /// once per picture. Valid until the next call of anything that changes the filter.
  [[nodiscard]] std::span<const Expectation> expect();
  /// Pixels that were found, and who was looked for where it was expected and not found; may be called
  /// several times per picture. Correction::removed names those (landmarks and candidates) that nobody needs
  /// to look for any more since the picture began.
  const Correction& correct(std::span<const Observation> found, std::span<const LandmarkId> missed);
  const Correction& correct(std::span<const Observation> observations) override {
    return correct(observations, {});
  }
  [[nodiscard]] PoseEstimate pose() const override { return map_.state().pose(); }
  [[nodiscard]] Snapshot snapshot() const override;
  [[nodiscard]] MapState save() const override;
  [[nodiscard]] const FunctionBlocks& blocks() const override { return blocks_; }

  [[nodiscard]] const ekf::PixelMap& map() const { return map_; }
  [[nodiscard]] int candidates() const;

 private:
  /// Something seen, whose depth particles find out.
  struct Candidate {
    LandmarkId id;
    int anchor = -1;                               ///< below 0: a free slot
    Eigen::Vector2d xy = Eigen::Vector2d::Zero();  ///< its ray, in the camera of the anchor
    Eigen::Matrix2d xy_covariance = Eigen::Matrix2d::Zero();
    ekf::DepthParticles depths;
    int pictures = 0;
    int looks = 0;
    int matches = 0;

    void start(LandmarkId seen, int from, const Eigen::Vector2d& ray_xy, const Eigen::Matrix2d& covariance);
  };
  /// A sighting with where it was expected.
  struct Sight {
    ekf::Sighting sighting;
    Eigen::Vector2d predicted;
  };
  /// The joint covariance of robot and anchor, and their places: what a candidate's pixel depends on.
  struct Baseline {
    CameraPose here, anchor;
    Eigen::Matrix<double, 6, 6> P;
  };
  struct PredictedPixel {
    Eigen::Vector2d pixel;
    Eigen::Matrix2d S;
  };

  void begin_picture();
  void miss(std::span<const LandmarkId> landmarks);
  using PixelJacobian = Eigen::Matrix<double, 2, 3>;  ///< d(u, v)/d(point in the camera frame)
  [[nodiscard]] ekf::ErrorTerms vibration(const Eigen::Vector3d& p_camera, const PixelJacobian& J) const;
  [[nodiscard]] Eigen::Matrix2d model_noise() const;
  [[nodiscard]] Eigen::Matrix2d noise(const Observation& observation) const;

  template <class Values>
  [[nodiscard]] std::optional<Sight> look(const ekf::PixelMap::Feature& feature, const CameraPose& here,
                                          const Values& values) const;
  [[nodiscard]] CameraPose camera_pose() const { return camera_.pose(pose().T_world_robot); }
  [[nodiscard]] std::optional<Sight> sight(int index, const CameraPose& here) const;
  [[nodiscard]] bool is_in_view(const ekf::PixelMap::Feature& feature, const CameraPose& here,
                                const Eigen::Vector2d& pixel) const;
  [[nodiscard]] Eigen::Vector3d place(const ekf::PixelMap::Feature& feature) const;
  [[nodiscard]] double wandered_px2(const Eigen::Vector3d& p_world, const Eigen::Vector3d& from,
                                    const Eigen::Vector3d& to) const;
  void let_wander(int index, const Eigen::Vector3d& p_world, const CameraPose& here);
  void expect_feature(int index, const CameraPose& here);
  void expect_candidate(const Candidate& candidate);

  [[nodiscard]] Baseline baseline(const Candidate& candidate) const;
  [[nodiscard]] std::optional<PredictedPixel> predict_pixel(const Candidate& candidate,
                                                            const Baseline& baseline, double rho) const;

  void sort_out(std::size_t index, const Observation& observation);
  void update(std::span<const Observation> observations);
  void collect(std::size_t index, const Observation& observation, const CameraPose& here);
  [[nodiscard]] std::optional<Eigen::Matrix2d> settle(std::size_t index, const Observation& observation,
                                                      const CameraPose& here);
  void update_agreeing(std::span<const Observation> observations);
  void judge_returning(const ekf::State::JointCovariance& S, std::span<const char> agrees, std::size_t known);
  void update_gated(std::span<const Observation> observations);
  void update_matched(std::span<const Observation> observations);
  [[nodiscard]] bool apply(std::span<const Observation> observations);
  [[nodiscard]] bool relinearize(std::span<const Observation> observations);
  void rescue(std::span<const Observation> observations);
  void book(std::size_t k);
  void settle_rays();
  void weigh(std::size_t index, std::span<const Observation> observations);
  int add_ray(LandmarkId id, int anchor, const Eigen::Vector3d& ray, const Eigen::Matrix3d& covariance,
              const ekf::ErrorTerms& errors, int observations);
  void accept(Candidate& candidate, std::size_t index, std::span<const Observation> observations);
  void confirm(std::size_t index, std::span<const Observation> observations);
  void begin(std::size_t index, const Observation& observation);
  [[nodiscard]] ekf::ErrorTerms shaken_ray(const PixelRay& ray) const;
  [[nodiscard]] ekf::DepthParticles::Spread unknown_depth() const;
  [[nodiscard]] ekf::DepthParticles::Spread inverse_depth(int index) const;
  [[nodiscard]] bool free_an_anchor();
  void drop(Candidate& candidate);
  void retire();
  [[nodiscard]] bool make_room();
  void remove(int feature);
  [[nodiscard]] Candidate* find_candidate(LandmarkId id);

  PixelSlamOptions options_;
  Camera camera_;
  ekf::PixelMap map_;
  ekf::MapManagement management_;
  ekf::Agreement agreement_;
  ekf::Agreement return_;  ///< of those that come back after long
  double gate_;
  double agreement_gate_;
  std::vector<Candidate> candidates_;
  std::optional<int> anchor_;  ///< of what begins in this picture
  bool in_picture_ = false;

  std::vector<Expectation> expectations_;
  std::vector<Innovation> innovations_;
  std::vector<ekf::Sighting> sightings_;
  std::vector<Eigen::Vector2d> nus_;
  std::vector<std::size_t> returning_;   // of the block, that come back after long
  std::vector<std::size_t> seen_;        // the observations of the block
  std::vector<ekf::PoseSighting> told_;  // what each of the block told about the pose
  std::vector<std::size_t> used_;        // those that are in the update
  std::vector<ekf::Sighting> refined_;   // linearised where the update leads
  std::vector<LandmarkId> removed_;
  Correction correction_;
  // Vincke Table 1
  FunctionBlocks blocks_{"FB1 predict",  "FB3 project", "FB5 Jacobians",
                         "FB6 estimate", "FB8 weights", "FB9 add"};
};

}  // namespace waymark
