#pragma once

#include <string>
#include <string_view>

namespace vdbeam {

/// The text as HTML shows it, in an element or in a quoted attribute: UTF-8, on one line, with
/// references for & < > " and '.
std::string html_text(std::string_view text);

/// "0.0012", "3.4e-05", "12": a number with three significant digits.
std::string number_text(double value);

} // namespace vdbeam
