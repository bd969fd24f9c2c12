#pragma once

namespace waymark {

/// Prints what a step of the compressed EKF costs in a map of so many landmarks, of a third of them and of a
/// thirtieth, and in that of a third how far it is from the whole filter on the same drive.
int compressed(int landmarks, int steps, int threads);

}  // namespace waymark
