#include "waymark/markers/dictionary_check.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "waymark/core/text.hpp"
#include "waymark/markers/black_border.hpp"

namespace waymark::markers {
namespace {

// Below these a log is looked at again: sightings per picture, and the part of them that last.
constexpr double kSightingsMin = 0.1;
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

std::optional<Finds> look_for(const MarkerDictionary& dictionary,
                              std::span<const std::shared_ptr<const GreyImage>> pictures) {
  const auto detector = make_marker_detector(dictionary);
  if (!detector) return std::nullopt;
  Finds finds{dictionary};
  for (const auto& picture : pictures)
    for (const Marker& marker : (*detector)->detect(*picture)) {
      if (!has_black_border(*picture, marker.corners_px, dictionary.bits_per_side + 2)) continue;
      ++finds.markers;
      finds.largest_id = std::max(finds.largest_id, marker.id);
    }
  return finds;
}

}  // namespace

void DictionaryCheck::add(std::shared_ptr<const GreyImage> picture, std::span<const std::int32_t> ids) {
  std::set<std::int32_t> seen(ids.begin(), ids.end());
  sightings_ += std::ssize(seen);
  steady_ += std::ranges::count_if(seen, [this](std::int32_t id) { return last_ids_.contains(id); });
  all_ids_.insert(seen.begin(), seen.end());
  if (pictures_++ % every_ == 0) {
    if (samples_.size() == kSamples) {
      for (std::size_t i = 0; 2 * i < kSamples; ++i) samples_[i] = std::move(samples_[2 * i]);
      samples_.resize(kSamples / 2);
      every_ *= 2;
    }
    if ((pictures_ - 1) % every_ == 0) samples_.push_back({std::move(picture), seen});
  }
  last_ids_ = std::move(seen);
}

bool DictionaryCheck::is_suspicious() const {
  const auto pictures = static_cast<double>(pictures_), sightings = static_cast<double>(sightings_);
  return pictures_ > 0 && (sightings < kSightingsMin * pictures ||
                           (pictures_ > 2 && static_cast<double>(steady_) < kSteadyMin * sightings));
}

std::optional<std::string> DictionaryCheck::verdict() const {
  if (!is_suspicious()) return std::nullopt;
  std::vector<std::shared_ptr<const GreyImage>> pictures;
  std::size_t own = 0;
  for (const Sample& sample : samples_) {
    pictures.push_back(sample.picture);
    own += sample.ids.size();
  }
  std::optional<Finds> best;
  for (const MarkerDictionary& dictionary : marker_dictionaries()) {
    if (has_larger(dictionary)) continue;
    const auto finds = look_for(dictionary, pictures);
    if (finds && (!best || finds->markers > best->markers)) best = finds;
  }
  const std::string found =
      concat("markers.dictionary: ", dictionary_.name, " found ", sightings_, " markers of ", all_ids_.size(),
             " identities in ", pictures_, " pictures");
  if (best && best->markers >= kMoreMin && best->markers > kMoreByFactor * own)
    return concat(found, "; in ", pictures.size(), " of them ",
                  smallest_with(best->dictionary, best->largest_id).name, " finds ", best->markers,
                  " where it finds ", own, ": it is probably the right one");
  if (sightings_ == 0) return found + ", and no other dictionary that this build knows does better";
  return std::nullopt;
}

}  // namespace waymark::markers
