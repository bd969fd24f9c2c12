#pragma once

#include "workbench/eval/evaluate.hpp"
#include "workbench/logs/trajectory_file.hpp"

namespace waymark::eval {

/// Scores a path in space, as evaluate() does on the plane: position errors from the start (placed by its
/// first pose, or where either path has no orientation by its first position and the turn of the whole) and
/// aligned by one rigid motion of least squares (Umeyama 1991, no reflection, no scale), and as heading the
/// angle between the orientations. No covariances, landmarks or drift. The notes say why and how to choose a
/// plane. O(n + m).
[[nodiscard]] Evaluation evaluate_in_space(const SpacePath& estimate, const SpacePath& truth,
                                           const AssociateOptions& options = {});

}  // namespace waymark::eval
