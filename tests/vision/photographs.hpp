#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/data_dir.hpp"

#include "workbench/logs/image_file.hpp"

namespace waymark::test {

/// A photograph of the gray-images collection.
inline GreyImage photograph(const std::string& name) {
  auto image = read_image(data_path("gray-images/" + name));
  EXPECT_TRUE(image.ok()) << (image.ok() ? "" : image.error().message);
  return image.ok() ? *std::move(image) : GreyImage();
}

inline const std::vector<std::string>& photograph_names() {
  static const std::vector<std::string> names{"graf1.png",    "graf3.png",        "leuvenA.jpg",
                                              "leuvenB.jpg",  "rubberwhale1.png", "box.png",
                                              "building.jpg", "home.jpg",         "blox.jpg"};
  return names;
}

}  // namespace waymark::test
