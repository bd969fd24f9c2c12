#include "waymark/markers/marker_options.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "waymark/core/text.hpp"

namespace waymark::markers {
namespace {

/// A number that takes the whole text.
template <class Number>
bool parse(std::string_view text, Number& number) {
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), number);
  return failure == std::errc() && end == text.data() + text.size();
}

Result<std::map<std::int32_t, double>> parse_sizes(std::string text, int count) {
  std::erase_if(text, [](char c) { return c == ' ' || c == '{' || c == '}'; });
  std::map<std::int32_t, double> sizes_m;
  for (std::string_view rest = text; !rest.empty();) {
    const std::string_view entry = rest.substr(0, rest.find(','));
    rest.remove_prefix(std::min(rest.size(), entry.size() + 1));
    const std::size_t colon = entry.find(':');
    std::int32_t id = -1;
    double size_m = 0.0;
    if (colon == std::string_view::npos || !parse(entry.substr(0, colon), id) || id < 0 || id >= count ||
        !parse(entry.substr(colon + 1), size_m) || !(size_m > 0.0) || !std::isfinite(size_m))
      return Error{concat("markers.sizes_m: '", entry,
                          "' is not the size of a marker; expected identities below ", count,
                          " and sides in metres like '3: 0.1, 7: 0.25'")};
    sizes_m[id] = size_m;
  }
  return sizes_m;
}

}  // namespace

double MarkerSet::size_of(std::int32_t id) const {
  const auto own = sizes_m.find(id);
  return own != sizes_m.end() ? own->second : size_m;
}

Result<MarkerSet> marker_set(const MarkerOptions& options) {
  if (options.dictionary.empty())
    return Error{
        "markers.dictionary is not set: give the dictionary of the markers, for example 4x4_50 or "
        "apriltag_36h11; `waymark config markers` lists all"};
  const auto dictionary = find_marker_dictionary(options.dictionary);
  if (!dictionary) return dictionary.error();
  auto sizes_m = parse_sizes(options.sizes_m, dictionary->size);
  if (!sizes_m) return sizes_m.error();
  if (options.size_m == 0.0 && sizes_m->empty())
    return Error{
        "markers.size_m is not set: give the side of the black squares of the markers in metres, for example "
        "0.085, or markers.sizes_m if they differ"};
  return MarkerSet{*dictionary, options.size_m, *std::move(sizes_m)};
}

}  // namespace waymark::markers
