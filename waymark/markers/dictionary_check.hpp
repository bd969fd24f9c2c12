#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "waymark/core/grey_image.hpp"
#include "waymark/markers/marker_detector.hpp"

namespace waymark::markers {

/// Notices that markers are searched for in the wrong dictionary: hardly one is found, or they come and go,
/// while another dictionary finds more in some of the same images.
class DictionaryCheck {
 public:
  explicit DictionaryCheck(const MarkerDictionary& dictionary) : dictionary_(dictionary) {}

  /// Called with every image and what was found in it.
  void add(std::shared_ptr<const GreyImage> image, std::span<const std::int32_t> ids);

  /// One line if the dictionary looks wrong; tries the others then, which takes some 0.5 s.
  [[nodiscard]] std::optional<std::string> verdict() const;

 private:
  static constexpr std::size_t kSamples = 8;

  /// Images spread evenly over the log.
  struct Sample {
    std::shared_ptr<const GreyImage> image;
    std::set<std::int32_t> ids;
  };

  [[nodiscard]] bool is_suspicious() const;

  MarkerDictionary dictionary_;
  std::int64_t images_ = 0;
  std::int64_t observations_ = 0;
  std::int64_t steady_ = 0;  ///< observations of what the image before showed, too
  std::set<std::int32_t> last_ids_;
  std::set<std::int32_t> all_ids_;
  std::int64_t every_ = 1;
  std::vector<Sample> samples_;
};

}  // namespace waymark::markers
