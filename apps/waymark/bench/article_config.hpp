#pragma once

namespace waymark::app {

/// The text of configs/vincke2012.yaml.
extern const char* const kArticleConfig;

}  // namespace waymark::app
