#pragma once

namespace vdbeam {

/// The style sheet and the script of a batch's page, to stand in <style> and <script>.
extern const char* const page_style;
extern const char* const page_script;

} // namespace vdbeam
