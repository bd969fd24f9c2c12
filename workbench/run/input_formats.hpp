#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "waymark/core/result.hpp"

#include "workbench/datasets/mat_file.hpp"
#include "workbench/logs/source.hpp"
#include "workbench/run/input_options.hpp"

namespace waymark {

/// A format in which recordings lie on disk.
struct InputFormat {
  enum class Place {
    kFolder,  ///< several files in a folder, none of which is a log alone
    kFile,
    kEither  ///< a file, or the folder that it lies in
  };

  std::string name;     ///< "an MRCLAM directory"
  std::string expects;  ///< what it is recognised by: "MRCLAM's Barcodes.dat with RobotN_Odometry.dat"
  Place place;
  bool (*recognises)(const std::filesystem::path& path);  ///< only asked of what lies at such a place
  Result<std::unique_ptr<Source>> (*open)(const std::filesystem::path& path, const InputOptions& options);

  /// Can a log of this format be a folder, or a file?
  [[nodiscard]] bool can_be(Place asked) const { return place == asked || place == Place::kEither; }
};

/// A log that is one .mat file, known by the variables in it.
struct MatFormat {
  std::string name;     ///< "Plaza"
  std::string expects;  ///< "GT, DR, TD"
  std::string file;     ///< how it is called where other .mat files lie beside it; else empty
  bool (*recognises)(const MatFile& file);
  Result<std::unique_ptr<Source>> (*open)(const MatFile& file, const InputOptions& options);
};

/// All formats, in the order in which they are tried: the first that recognises a path opens it. A new one is
/// a reader in a file of its own, and an entry here; one that is a .mat file has it in mat_formats() instead.
[[nodiscard]] std::span<const InputFormat> input_formats();

[[nodiscard]] std::span<const MatFormat> mat_formats();

}  // namespace waymark
