#pragma once

#include <string>
#include <vector>

namespace vdbeam {

/// A range expression of Open Job Description for sorted frames without doubles: "1-24",
/// "1-99:2", "1,5,9-12". Three frames or more with the same distance become one range; ranges never
/// overlap, which the specification forbids (Template Schemas 2023-09, section 3.4.1.1.1).
std::string openjd_range(const std::vector<int>& frames);

} // namespace vdbeam
