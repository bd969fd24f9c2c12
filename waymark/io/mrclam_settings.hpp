#pragma once

namespace waymark {

/// The text of configs/mrclam.yaml, built in.
extern const char* const kMrclamSettings;

}  // namespace waymark
