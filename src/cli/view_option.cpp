#include "cli/view_option.h"

#include "image/view_transform.h"

#include <fmt/format.h>
#include <vector>

namespace vdbeam::cli {

void add_view(CLI::App& app, std::string& view) {
  std::vector<std::string> names;
  std::string words, descriptions;
  for (const ViewTransform& entry : view_transforms()) {
    names.emplace_back(entry.name);
    words += fmt::format("{}{}", words.empty() ? "" : "|", entry.name);
    descriptions +=
        fmt::format("{}{}: {}", descriptions.empty() ? "" : "; ", entry.name, entry.description);
  }
  view = names.front();
  app.add_option("--view", view, "View transform of 8-bit images. " + descriptions)
      ->check(CLI::IsMember(names))
      ->option_text(words);
}

} // namespace vdbeam::cli
