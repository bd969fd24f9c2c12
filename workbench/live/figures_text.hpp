#pragma once

#include <string>

#include "waymark/slam/pipeline_counts.hpp"

#include "workbench/live/session.hpp"

namespace waymark::live {

/// What the operating system did to the process.
struct ProcessFigures {
  long major_faults = 0;          ///< pages that had to be read from disk
  long involuntary_switches = 0;  ///< times that another program was given the core
};

[[nodiscard]] ProcessFigures process_figures();

/// The table at the end of a session: latencies, and each stream with what it brought and lost.
[[nodiscard]] std::string to_text(const SessionFigures& figures, const PipelineCounts& counts,
                                  const ProcessFigures& process);

/// The same as live.json.
[[nodiscard]] std::string to_json(const SessionFigures& figures, const PipelineCounts& counts,
                                  const ProcessFigures& process);

}  // namespace waymark::live
