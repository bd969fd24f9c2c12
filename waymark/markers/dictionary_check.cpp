#include "waymark/markers/dictionary_check.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "waymark/core/text.hpp"
#include "waymark/markers/black_border.hpp"

namespace waymark::markers {
namespace {

// Below these a log is looked at again: observations per image, and the part of them that last.
constexpr double kObservationsMin = 0.1;
constexpr double kSteadyMin = 0.5;
// How much more another dictionary must find.
constexpr std::size_t kMoreByFactor = 2;
constexpr std::size_t kMoreMin = 2;

/// What all of the samples show of one dictionary.
struct Finds {
  MarkerDictionary dictionary;
  std::size_t markers = 0;
  std::int32_t largest_id = 0;
};

bool has_larger(const MarkerDictionary& dictionary) {
  return std::ranges::any_of(marker_dictionaries(), [&](const MarkerDictionary& each) {
    return each.kind == MarkerKind::kAruco && each.size > dictionary.size &&
           smallest_with(each, 0).name == smallest_with(dictionary, 0).name;
  });
}

std::optional<Finds> search_for(const MarkerDictionary& dictionary,
                                std::span<const std::shared_ptr<const GreyImage>> images) {
  const auto detector = make_marker_detector(dictionary);
  if (!detector) return std::nullopt;
  Finds finds{dictionary};
  for (const auto& image : images)
    for (const Marker& marker : (*detector)->detect(*image)) {
      if (!has_black_border(*image, marker.corners_px, dictionary.bits_per_side + 2)) continue;
      ++finds.markers;
      finds.largest_id = std::max(finds.largest_id, marker.id);
    }
  return finds;
}

}  // namespace

void DictionaryCheck::add(std::shared_ptr<const GreyImage> image, std::span<const std::int32_t> ids) {
  std::set<std::int32_t> seen(ids.begin(), ids.end());
  observations_ += std::ssize(seen);
  steady_ += std::ranges::count_if(seen, [this](std::int32_t id) { return last_ids_.contains(id); });
  all_ids_.insert(seen.begin(), seen.end());
  if (images_++ % every_ == 0) {
    if (samples_.size() == kSamples) {
      for (std::size_t i = 0; 2 * i < kSamples; ++i) samples_[i] = std::move(samples_[2 * i]);
      samples_.resize(kSamples / 2);
      every_ *= 2;
    }
    if ((images_ - 1) % every_ == 0) samples_.push_back({std::move(image), seen});
  }
  last_ids_ = std::move(seen);
}

bool DictionaryCheck::is_suspicious() const {
  const auto images = static_cast<double>(images_), observations = static_cast<double>(observations_);
  return images_ > 0 && (observations < kObservationsMin * images ||
                         (images_ > 2 && static_cast<double>(steady_) < kSteadyMin * observations));
}

std::optional<std::string> DictionaryCheck::verdict() const {
  if (!is_suspicious()) return std::nullopt;
  std::vector<std::shared_ptr<const GreyImage>> images;
  std::size_t own = 0;
  for (const Sample& sample : samples_) {
    images.push_back(sample.image);
    own += sample.ids.size();
  }
  std::optional<Finds> best;
  for (const MarkerDictionary& dictionary : marker_dictionaries()) {
    if (has_larger(dictionary)) continue;
    const auto finds = search_for(dictionary, images);
    if (finds && (!best || finds->markers > best->markers)) best = finds;
  }
  const std::string found = concat("markers.dictionary: ", dictionary_.name, " found ", observations_,
                                   " markers of ", all_ids_.size(), " identities in ", images_, " images");
  if (best && best->markers >= kMoreMin && best->markers > kMoreByFactor * own)
    return concat(found, "; in ", images.size(), " of them ",
                  smallest_with(best->dictionary, best->largest_id).name, " finds ", best->markers,
                  " where it finds ", own, ", so it is probably the right one");
  if (observations_ == 0) return found + ", and no other dictionary of this build finds more";
  return std::nullopt;
}

}  // namespace waymark::markers
