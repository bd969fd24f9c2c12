#pragma once

#include "waymark/core/filter.hpp"

#include "workbench/run/config.hpp"

namespace waymark::study {

/// How well a filter foretold an observation: the log of
///
///     p = (1 - e) N(nu; 0, S) + e u,   e = 1 %,
///
/// where u is the density of an observation of which nothing is known. An outlier costs no more than
/// log(e u), whatever S is: a filter gains nothing by refusing it, nor by a gate that is narrower. What was
/// not compared with anything (the first observation of a landmark, a duplicate) is as likely as u. So every
/// observation is one term in every run.
[[nodiscard]] double log_likelihood(const Innovation& innovation, double log_field_density);

/// log u: even over all ranges up to the longest that was seen, all bearings, or all pixels of the image.
[[nodiscard]] double log_field_density(const Config& config, double longest_range_m);

}  // namespace waymark::study
