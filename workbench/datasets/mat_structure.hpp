#pragma once

#include <string>
#include <string_view>

#include "waymark/core/result.hpp"

namespace waymark {

/// Whether the bytes of a file are what a reader of MATLAB files may be trusted with: a little-endian level 5
/// file ("MAT-File Format", MathWorks 2019, chapter 1) of plain real matrices, and cell arrays of them, whose
/// parts all have the size that they claim, with the checksum of what is compressed. Everything else is
/// refused: level 7.3, structures, text. `name` stands for the file in the error. O(size), which is at most
/// 256 MB unpacked.
[[nodiscard]] Result<void> check_mat_structure(std::string_view bytes, const std::string& name);

}  // namespace waymark
