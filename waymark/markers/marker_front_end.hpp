#pragma once

#include <array>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include "waymark/core/event.hpp"
#include "waymark/core/filter.hpp"
#include "waymark/core/function_blocks.hpp"
#include "waymark/core/grey_image.hpp"
#include "waymark/core/observation.hpp"
#include "waymark/core/result.hpp"
#include "waymark/markers/dictionary_check.hpp"
#include "waymark/markers/marker_detector.hpp"
#include "waymark/markers/marker_observation.hpp"
#include "waymark/markers/marker_options.hpp"
#include "waymark/models/camera.hpp"
#include "waymark/slam/front_end.hpp"

namespace waymark {

/// Finds markers in images, ahead of who needs them: on a thread of its own, or, without one, when they are
/// asked for. What it finds is the same either way.
class MarkerFinder {
 public:
  struct Finds {
    std::vector<markers::Marker> markers;
    Duration cpu{0};  ///< that it took
  };
  using SharedImage = FrontEnd::SharedImage;

  /// Throws std::system_error where the thread cannot be started.
  MarkerFinder(std::unique_ptr<markers::MarkerDetector> detector, bool own_thread);
  ~MarkerFinder();
  MarkerFinder(const MarkerFinder&) = delete;
  MarkerFinder& operator=(const MarkerFinder&) = delete;

  /// An image that will be taken or dropped.
  void announce(SharedImage image);
  /// What is in one that was announced; waits where need be. What was thrown while looking is thrown here.
  [[nodiscard]] Finds take(const SharedImage& image);
  /// It will not be needed.
  void drop(const SharedImage& image);

 private:
  [[nodiscard]] Finds look(const GreyImage& image);
  void work();
  void look_at_waiting();
  void stop();
  /// Waits for what becomes of an image: is it done?
  [[nodiscard]] bool is_done(const SharedImage& image, std::unique_lock<std::mutex>& lock);

  std::unique_ptr<markers::MarkerDetector> detector_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<SharedImage> waiting_;
  SharedImage at_work_;
  std::multimap<SharedImage, Finds> done_;
  bool stopping_ = false;
  std::exception_ptr failure_;        ///< with which the thread has ended
  std::vector<std::thread> threads_;  ///< one or none; last: it works on the others
};

/// What a camera sees of markers, as observations for a filter over range and bearing.
class MarkerFrontEnd final : public FrontEnd {
 public:
  /// Or what the options lack, or this build.
  [[nodiscard]] static Result<std::unique_ptr<MarkerFrontEnd>> make(const markers::MarkerOptions& options,
                                                                    const Camera& camera);

  [[nodiscard]] bool fits(const ImageView& image) const override;
  [[nodiscard]] bool corrects_filter() const override { return false; }
  [[nodiscard]] bool takes_outlines() const override { return true; }

  void announce(const SharedImage& image) override { finder_.announce(image); }
  void drop(const SharedImage& image) override { finder_.drop(image); }

  /// The markers in an image, each identity once.
  Seen see(const SharedImage& image) override;
  std::span<const Observation> see(const MarkerOutlines& outlines) override;

  [[nodiscard]] std::span<const FunctionBlocks::Row> blocks() const override { return blocks_.rows(); }
  [[nodiscard]] std::vector<std::string> notes(std::span<const Innovation> innovations) const override;

 private:
  MarkerFrontEnd(const markers::MarkerOptions& options, const markers::MarkerSet& set, const Camera& camera,
                 std::unique_ptr<markers::MarkerDetector> detector);

  void measure(const SharedImage& image, std::span<const markers::Marker> found);
  void measure(const MarkerOutlines& outlines);
  void take(const std::variant<Observation, markers::Refusal>& seen);
  void refuse_duplicates();
  void hold_back_new();

  /// Of an identity that is not believed yet.
  struct Trial {
    int observations = 0;
    std::int64_t last_image = 0;
  };

  Camera camera_;
  int confirm_;
  markers::MarkerObserver observer_;
  markers::DictionaryCheck check_;
  std::vector<Observation> observations_;
  std::array<std::int64_t, markers::kRefusals> refused_{};
  std::map<LandmarkId, std::int64_t> duplicates_;  ///< images that show an identity twice
  std::int64_t images_ = 0;
  std::map<LandmarkId, Trial> trials_;
  FunctionBlocks blocks_{"find markers", "measure markers"};
  MarkerFinder finder_;  ///< last, so that its thread ends before what it works on
};

}  // namespace waymark
