#include "workbench/logs/json_text.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace waymark {
namespace {

TEST(JsonText, IsOnOneLineOrIndented) {
  const nlohmann::ordered_json json{{"b", 1}, {"a", {2}}};
  EXPECT_EQ(json_text(json), R"({"b":1,"a":[2]})");
  EXPECT_EQ(json_text(json, 1), "{\n \"b\": 1,\n \"a\": [\n  2\n ]\n}");
}

TEST(JsonText, WhatIsNotUtf8IsReplacedInValuesAndKeys) {
  EXPECT_EQ(json_text(nlohmann::json{{"R\xe4ume", "\xff"}}), "{\"R\xef\xbf\xbdume\":\"\xef\xbf\xbd\"}");
  EXPECT_EQ(json_text(nlohmann::json("R\xc3\xa4ume")), "\"R\xc3\xa4ume\"");
}

}  // namespace
}  // namespace waymark
