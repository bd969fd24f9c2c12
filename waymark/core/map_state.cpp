#include "waymark/core/map_state.hpp"

#include "waymark/core/text.hpp"

namespace waymark {

Result<void> check_fits(const MapState& map, int landmark_dimension, int capacity) {
  const std::ptrdiff_t count = std::ssize(map.ids);
  if (map.landmark_dimension != landmark_dimension)
    return Error{
        concat("map: its landmarks are of dimension ", map.landmark_dimension, ", not ", landmark_dimension)};
  if (count > capacity)
    return Error{concat("map: ", count, " landmarks are more than the capacity of the filter, ", capacity)};
  const Eigen::Index size = 3 + landmark_dimension * count;
  if (std::ssize(map.observations) != count || map.landmarks.size() != size - 3 ||
      map.covariance.rows() != size || map.covariance.cols() != size)
    return Error{concat("map: ", count, " landmarks of dimension ", landmark_dimension, " need a mean of ",
                        size - 3, " numbers and a covariance of ", size, " rows and columns")};
  if (!map.landmarks.allFinite() || !map.covariance.allFinite())
    return Error{"map: a landmark or its covariance is not finite"};
  return {};
}

}  // namespace waymark
