#include "waymark/core/failure.hpp"

#include <new>
#include <stdexcept>

namespace waymark {
namespace {

/// A container that is asked for more than any memory holds throws std::length_error.
bool is_memory(const std::exception& problem) {
  return dynamic_cast<const std::bad_alloc*>(&problem) != nullptr ||
         dynamic_cast<const std::length_error*>(&problem) != nullptr;
}

}  // namespace

Error failure(const std::exception& problem) {
  return {is_memory(problem) ? "out of memory" : problem.what(), Error::Kind::kFailed};
}

}  // namespace waymark
