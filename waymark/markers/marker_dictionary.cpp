#include "waymark/markers/marker_dictionary.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>

#include "waymark/core/names.hpp"
#include "waymark/core/text.hpp"

namespace waymark::markers {
namespace {

// ArUco: 0.6 of the bits that the least distance between two patterns allows to correct, but no more than let
// one in 300 squares of random bits pass; that is the part of 4x4_50 with none corrected.
constexpr std::array kDictionaries{
    MarkerDictionary{"4x4_50", MarkerKind::kAruco, 50, 4},
    MarkerDictionary{"4x4_100", MarkerKind::kAruco, 100, 4},
    MarkerDictionary{"4x4_250", MarkerKind::kAruco, 250, 4},
    MarkerDictionary{"4x4_1000", MarkerKind::kAruco, 1000, 4},
    MarkerDictionary{"5x5_50", MarkerKind::kAruco, 50, 5, 1},
    MarkerDictionary{"5x5_100", MarkerKind::kAruco, 100, 5, 1},
    MarkerDictionary{"5x5_250", MarkerKind::kAruco, 250, 5, 1},
    MarkerDictionary{"5x5_1000", MarkerKind::kAruco, 1000, 5, 1},
    MarkerDictionary{"6x6_50", MarkerKind::kAruco, 50, 6, 3},
    MarkerDictionary{"6x6_100", MarkerKind::kAruco, 100, 6, 3},
    MarkerDictionary{"6x6_250", MarkerKind::kAruco, 250, 6, 3},
    MarkerDictionary{"6x6_1000", MarkerKind::kAruco, 1000, 6, 2},
    MarkerDictionary{"7x7_50", MarkerKind::kAruco, 50, 7, 5},
    MarkerDictionary{"7x7_100", MarkerKind::kAruco, 100, 7, 4},
    MarkerDictionary{"7x7_250", MarkerKind::kAruco, 250, 7, 4},
    MarkerDictionary{"7x7_1000", MarkerKind::kAruco, 1000, 7, 3},
    MarkerDictionary{"aruco_original", MarkerKind::kAruco, 1024, 5},
    MarkerDictionary{"apriltag_16h5", MarkerKind::kAprilTag, 30, 4, 0},
    MarkerDictionary{"apriltag_25h9", MarkerKind::kAprilTag, 35, 5, 1},
    MarkerDictionary{"apriltag_36h10", MarkerKind::kAprilTag, 2320, 6, 1},
    MarkerDictionary{"apriltag_36h11", MarkerKind::kAprilTag, 587, 6, 2},
};

std::vector<std::string> names() {
  std::vector<std::string> all;
  for (const MarkerDictionary& each : kDictionaries) all.emplace_back(each.name);
  return all;
}

/// DICT_4X4_50 is 4x4_50, and tag36h11 or 36h11 apriltag_36h11.
std::string plain(std::string_view given) {
  std::string name(given);
  std::ranges::transform(name, name.begin(), [](char c) {
    return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  });
  for (const std::string_view prefix : {"dict_", "apriltag_", "apriltag", "tag"})
    if (name.starts_with(prefix)) name.erase(0, prefix.size());
  return name.find('h') == 2 ? "apriltag_" + name : name;
}

}  // namespace

std::span<const MarkerDictionary> marker_dictionaries() { return kDictionaries; }

Result<MarkerDictionary> find_marker_dictionary(std::string_view name) {
  const auto found = std::ranges::find(kDictionaries, plain(name), &MarkerDictionary::name);
  if (found != kDictionaries.end()) return *found;
  const std::string near = nearest_name(name, names());
  return Error{concat("markers.dictionary: unknown dictionary '", name, "'",
                      near.empty() ? "" : concat(", did you mean '", near, "'?"), "; known are ",
                      comma_separated(names()))};
}

MarkerDictionary smallest_with(const MarkerDictionary& dictionary, int number) {
  if (dictionary.name.find('x') == std::string_view::npos) return dictionary;
  return *std::ranges::find_if(kDictionaries, [&](const MarkerDictionary& each) {
    return each.name.substr(0, 3) == dictionary.name.substr(0, 3) && each.size > number;
  });
}

}  // namespace waymark::markers
