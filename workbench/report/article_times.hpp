#pragma once

#include <optional>
#include <string_view>

#include "workbench/run/config.hpp"

namespace waymark {

/// What a function block took in the article (Vincke, Elouardi, Lambert 2012, table 2; FB1 from its text): on
/// one ARM Cortex-A8 of 500 MHz without vector instructions.
struct ArticleTime {
  std::string_view block;  ///< "FB2"
  double per_call_us = 0.0;
  double calls_per_frame = 0.0;
  double per_frame_us = 0.0;
};

/// Whether a run is of the article's system, as configs/vincke2012.yaml sets it.
[[nodiscard]] bool is_article_system(const Config& config);

/// The published time of a block whose name begins with its number, as "FB2 corners".
[[nodiscard]] std::optional<ArticleTime> article_time(std::string_view block_name);

/// A frame of the article: as above, and with vector instructions and a second processor.
inline constexpr double kArticleFrame_us = 80850.0;
inline constexpr double kArticleOptimisedFrame_us = 17600.0;

}  // namespace waymark
