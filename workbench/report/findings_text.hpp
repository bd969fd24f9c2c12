#pragma once

#include <string>
#include <vector>

#include "workbench/calibrate/findings.hpp"

namespace waymark {

/// What was found about a robot in so many runs over a log, as a table for a person.
[[nodiscard]] std::string findings_text(const std::vector<calibrate::CalibrationFinding>& findings, int runs,
                                        const std::string& input);

/// The same as a JSON object: value, sigma, before and whether the log told, by key.
[[nodiscard]] std::string findings_json(const std::vector<calibrate::CalibrationFinding>& findings);

}  // namespace waymark
