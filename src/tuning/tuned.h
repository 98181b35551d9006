#pragma once

/// Defines a fitted number. A build with the CMake option VDBEAM_TUNING reads it from the
/// environment variable VDBEAM_TUNE ("name=value,name=value") instead, so that tools/sensitivity.py
/// can measure what the number does; every other build has a constant.
#ifdef VDBEAM_TUNING
#define VDBEAM_TUNED(type, name, value) inline const type name = tuned<type>(#name, value)

#include <cstdlib>
#include <string>

namespace vdbeam::tuning {

template <class T>
T tuned(const std::string& name, T value) {
  const char* const given = std::getenv("VDBEAM_TUNE");
  const std::string all = given ? std::string(",") + given : std::string();
  const std::size_t at = all.find("," + name + "=");
  return at == std::string::npos ? value
                                 : static_cast<T>(std::stod(all.substr(at + name.size() + 2)));
}

} // namespace vdbeam::tuning
#else
#define VDBEAM_TUNED(type, name, value) inline constexpr type name = value
#endif
