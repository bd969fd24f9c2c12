#pragma once

namespace waymark {

/// Prints what a step of the compressed EKF costs in maps of 100, 1000 and 3000 landmarks, and how far it is
/// from the whole filter on the same drive.
int compressed(int steps, int threads);

}  // namespace waymark
