#include "scene/toml_nesting.h"

#include "text/text.h"
#include "vdbeam/error.h"

#include <fmt/format.h>
#include <string_view>

namespace vdbeam {
namespace {

/// Goes through TOML and counts the dots between the characters that end a key or a value. Numbers
/// count too, and have one.
class DotCounter {
public:
  DotCounter(const std::string& text, const std::string& source) : text_(text), source_(source) {}

  void run() {
    while (at_ < text_.size())
      step();
  }

private:
  void step() {
    const char c = text_[at_];
    if (c == '"' || c == '\'')
      return skip_string(c);
    if (c == '#')
      return skip_to_end_of_line();
    if (c == '.' && ++dots_ >= most_dotted_names)
      throw InputError(one_line(fmt::format("{}:{}: a key has more than {} names between dots; no "
                                            "key of a scene has more than 4",
                                            source_, line_, most_dotted_names)));
    if (std::string_view("\n=,[]{}").find(c) != std::string_view::npos)
      dots_ = 0;
    line_ += c == '\n';
    ++at_;
  }

  void skip_to_end_of_line() {
    while (at_ < text_.size() && text_[at_] != '\n')
      ++at_;
  }

  /// A string of one line ends with that line at the latest, as toml++ has it.
  void skip_string(char quote) {
    const std::string three(3, quote);
    const bool several_lines = text_.compare(at_, 3, three) == 0;
    at_ += several_lines ? 3 : 1;
    for (; at_ < text_.size(); ++at_) {
      if (text_[at_] == '\n') {
        if (!several_lines)
          return;
        ++line_;
      } else if (text_[at_] == '\\' && quote == '"') {
        if (at_ + 1 < text_.size() && text_[at_ + 1] != '\n')
          ++at_;
      } else if (text_[at_] == quote && (!several_lines || text_.compare(at_, 3, three) == 0)) {
        at_ += several_lines ? 3 : 1;
        return;
      }
    }
  }

  const std::string& text_;
  const std::string& source_;
  std::size_t at_ = 0, line_ = 1, dots_ = 0;
};

} // namespace

void check_nesting(const std::string& text, const std::string& source) {
  DotCounter(text, source).run();
}

} // namespace vdbeam
