#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace waymark::kernels {

/// The instruction set that the kernels use, as Highway calls it: "AVX3_ZEN4".
[[nodiscard]] const char* instruction_set();

/// Those that the kernels can use on this processor, the best first, in lower case: "avx2", "sse4".
[[nodiscard]] std::vector<std::string> instruction_sets();

/// Has the kernels use one of instruction_sets() instead of the best; false: it is none of them, and nothing
/// changes. Results differ in the last bits between instruction sets, so this is for comparing runs bit by
/// bit. Not while a kernel runs.
[[nodiscard]] bool use_instruction_set(std::string_view name);

}  // namespace waymark::kernels
