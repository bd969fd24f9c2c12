#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "waymark/core/result.hpp"

#include "workbench/bags/bag_options.hpp"
#include "workbench/bags/reader.hpp"
#include "workbench/bags/topic_reader.hpp"
#include "workbench/logs/source.hpp"

namespace waymark::bag {

/// A topic that becomes events, and where these stand among others of the same stamp.
struct PlannedTopic {
  TopicReader reader;
  int order = 0;
};

/// What is used of a bag, and what that says about the robot.
struct TopicPlan {
  std::map<std::size_t, PlannedTopic> used;  ///< by place in the bag's summary
  LogInfo info;
  std::vector<std::string> notes;
};

/// Settles which topics are used, by type and by what the user said; where several would do, the type that
/// says more, then more messages, then the name decides, and a note says so. Looks at the first message of
/// each and at all of tf_static, and leaves the bag rewound to the topics in use.
[[nodiscard]] Result<TopicPlan> plan_topics(Reader& bag, const std::string& name, const BagOptions& options);

}  // namespace waymark::bag
