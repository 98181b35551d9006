#pragma once

#include <string>

namespace vdbeam {

/// A fingerprint of how this machine performs the operations that IEEE 754 leaves open: the C
/// library's functions, which differ in the last digit between its versions and on CPUs without
/// fused multiply-add, and whether the SIMD queries fuse. Machines with equal fingerprints render
/// the same bits; 16 hexadecimal digits.
std::string arithmetic_fingerprint();

} // namespace vdbeam
