#pragma once

#include "vdbeam/error.h"

#include <exception>
#include <string>

namespace vdbeam::cli {

/// The message for an exception, and the exit code that it means.
struct Failure {
  std::string line;
  ExitCode code;
};

/// Describes any exception in the user's terms. Errors of files, of memory and of the system are
/// no defects of the program, whatever library throws them; only what is left is an internal error.
Failure describe(const std::exception& error);

} // namespace vdbeam::cli
