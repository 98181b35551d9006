#pragma once

#include <string>

namespace vdbeam {

/// A fingerprint of what this machine makes of the operations that IEEE 754 leaves open: the C
/// library's functions, which differ in the last digit between its versions and on CPUs without
/// fused multiply-add, and whether the SIMD queries fuse. Machines that agree in it render the same
/// bits; 16 hexadecimal digits.
std::string arithmetic_fingerprint();

} // namespace vdbeam
