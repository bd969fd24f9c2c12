#pragma once

#include <string>

#include "workbench/study/tune.hpp"

namespace waymark::study {

/// The tuned keys as a config file, with what they were and their intervals as comments.
[[nodiscard]] std::string to_yaml(const TuneResult& result);

/// For people: a row per key, held-out scores, a row per log.
[[nodiscard]] std::string to_text(const TuneResult& result);

/// "0.1 to 0.2", "below 0.2", or that the logs do not tell; empty where that was not found out.
[[nodiscard]] std::string interval_text(const TunedKey& key);

/// What the scores are.
[[nodiscard]] std::string score_name(TuneBy by);

}  // namespace waymark::study
