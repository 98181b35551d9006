#include "batch/failure.h"

#include "text/text.h"

#include <filesystem>
#include <fmt/format.h>
#include <new>
#include <stdexcept>
#include <system_error>

namespace vdbeam::cli {
namespace {

const char* const out_of_memory = "not enough memory; use a lower --resolution or fewer photons";

} // namespace

Failure describe(const std::exception& error) {
  if (const auto* known = dynamic_cast<const Error*>(&error))
    return {known->what(), known->code()};
  // A size that no vector can have is memory that nobody has.
  if (dynamic_cast<const std::bad_alloc*>(&error) || dynamic_cast<const std::length_error*>(&error))
    return {out_of_memory, ExitCode::frame_failed};
  if (const auto* file = dynamic_cast<const std::filesystem::filesystem_error*>(&error))
    return {one_line(fmt::format("{}: {}", file->path1().string(), file->code().message())),
            ExitCode::bad_input};
  if (const auto* system = dynamic_cast<const std::system_error*>(&error))
    return {one_line(fmt::format("the system refused a resource: {}; check its limits (ulimit -a)",
                                 system->code().message())),
            ExitCode::frame_failed};
  return {one_line(fmt::format("internal error: {}", error.what())), ExitCode::internal_error};
}

} // namespace vdbeam::cli
