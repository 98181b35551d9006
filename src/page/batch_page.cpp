#include "page/batch_page.h"

#include "page/chart.h"
#include "page/html_text.h"
#include "page/page_assets.h"
#include "text/frame_range.h"
#include "text/text.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>

namespace vdbeam {
namespace {

/// Rendering time where the image gives it, else the frame's wall clock.
std::optional<double> seconds_of(const PageFrame& frame) {
  if (frame.picture.seconds)
    return frame.picture.seconds;
  return frame.status == "done" ? std::optional(frame.seconds) : std::nullopt;
}

std::vector<int> failed_frames(const BatchPage& page) {
  std::vector<int> failed;
  for (const PageFrame& frame : page.frames)
    if (frame.status == "failed")
      failed.push_back(frame.number);
  return failed;
}

/// |b - a| / ((a + b) / 2), and 0 for two black images.
double relative_change(double a, double b) {
  return a + b > 0 ? std::abs(b - a) / ((a + b) / 2) : 0;
}

Chart error_chart(const BatchPage& page) {
  Chart chart{"Error by frame", "MRSE", {}, failed_frames(page)};
  for (const PageFrame& frame : page.frames) {
    const ThumbnailFacts& facts = frame.picture;
    if (!facts.error)
      continue;
    std::string label = fmt::format("frame {}: MRSE {}", frame.number, number_text(*facts.error));
    if (facts.error_low && facts.error_high)
      label += fmt::format(" (95 %: {} to {})", number_text(*facts.error_low),
                           number_text(*facts.error_high));
    chart.points.push_back(
        {frame.number, *facts.error, facts.error_low, facts.error_high, std::move(label)});
  }
  return chart;
}

Chart seconds_chart(const BatchPage& page) {
  Chart chart{"Seconds by frame", "seconds", {}, failed_frames(page)};
  for (const PageFrame& frame : page.frames)
    if (const auto seconds = seconds_of(frame))
      chart.points.push_back(
          {.frame = frame.number,
           .value = *seconds,
           .label = fmt::format("frame {}: {}", frame.number, format_duration(*seconds))});
  return chart;
}

Chart change_chart(const BatchPage& page) {
  Chart chart{"Change of brightness by frame", "per cent", {}, failed_frames(page)};
  for (std::size_t i = 1; i < page.frames.size(); ++i) {
    const PageFrame &before = page.frames[i - 1], &frame = page.frames[i];
    if (before.thumbnail.empty() || frame.thumbnail.empty())
      continue;
    const double percent =
        100 * relative_change(before.picture.brightness, frame.picture.brightness);
    chart.points.push_back(
        {.frame = frame.number,
         .value = percent,
         .label = fmt::format("frame {} to {}: {:.3g} %", before.number, frame.number, percent)});
  }
  return chart;
}

std::string figure(const Chart& chart, const std::string& words) {
  return fmt::format("<figure><h3>{}</h3>{}<figcaption>{}</figcaption></figure>\n", chart.title,
                     chart_svg(chart), words);
}

std::string charts(const BatchPage& page) {
  return "<h2>Error and time</h2>\n<div class=\"charts\">\n" +
         figure(error_chart(page),
                "Estimated mean relative squared error (MRSE) of each image. The bar is its 95 % "
                "interval. An MRSE of 0.001 corresponds to noise of about 3 % of a pixel.") +
         figure(seconds_chart(page), "Rendering time of each frame on its machine.") +
         figure(change_chart(page),
                "Relative change of the mean brightness from the frame before. A single high point "
                "is a jump; what the shot itself changes counts as well. A cross marks a frame "
                "that failed.") +
         "</div>\n";
}

std::string tile(const std::string& value, const std::string& words, bool bad = false) {
  return fmt::format("<div class=\"tile{}\"><b>{}</b><span>{}</span></div>\n", bad ? " bad" : "",
                     value, words);
}

std::string tiles(const BatchPage& page) {
  std::string html = "<div class=\"tiles\">\n";
  const auto count = [&](const std::string& status) {
    return std::count_if(page.frames.begin(), page.frames.end(),
                         [&](const PageFrame& frame) { return frame.status == status; });
  };
  html += tile(fmt::format("{} of {}", count("done") + count("skipped"), page.frames.size()),
               "frames finished");
  if (const auto skipped = count("skipped"); skipped > 0)
    html += tile(std::to_string(skipped), "of them skipped: the image was there");
  html += tile(std::to_string(count("failed")), "failed", count("failed") > 0);
  if (const auto interrupted = count("interrupted"); interrupted > 0)
    html += tile(std::to_string(interrupted), "interrupted", true);
  if (const auto left = count(""); left > 0)
    html += tile(std::to_string(left), "not begun");
  double seconds = 0, worst = -1;
  int worst_frame = 0;
  for (const PageFrame& frame : page.frames) {
    seconds += seconds_of(frame).value_or(0);
    if (frame.picture.error.value_or(-1) > worst) {
      worst = *frame.picture.error;
      worst_frame = frame.number;
    }
  }
  html += tile(format_duration(seconds), "rendering, all frames together");
  if (worst >= 0)
    html += tile(number_text(worst), fmt::format("largest MRSE, frame {}", worst_frame));
  if (const auto change = flicker(page.frames))
    html += tile(fmt::format("{:.3g} %", 100 * *change),
                 "flicker: mean change of brightness between neighbouring frames");
  return html + "</div>\n";
}

/// Width over height of the first image; 16 over 9 where there is none.
double aspect(const BatchPage& page) {
  for (const PageFrame& frame : page.frames)
    if (frame.picture.height > 0)
      return static_cast<double>(frame.picture.width) / frame.picture.height;
  return 16.0 / 9;
}

std::string player(const BatchPage& page) {
  const auto count = std::count_if(page.frames.begin(), page.frames.end(),
                                   [](const PageFrame& frame) { return !frame.thumbnail.empty(); });
  if (count == 0)
    return "";
  constexpr double greatest_height = 24; // rem: two thirds of a low window
  std::string html = fmt::format("<h2>Film</h2>\n<div class=\"player\"><img id=\"film\" alt=\"\" "
                                 "style=\"max-width: {:.2f}rem; aspect-ratio: {:.4f}\">\n",
                                 greatest_height * aspect(page), aspect(page));
  html += "<div class=\"controls\"><button id=\"play\" type=\"button\">Play</button>";
  html += fmt::format("<input id=\"slider\" type=\"range\" min=\"0\" max=\"{}\" value=\"0\" "
                      "aria-label=\"frame\"><span id=\"place\"></span>",
                      count - 1);
  html += "<label>Frames per second <select id=\"rate\">";
  for (const int rate : {6, 12, 24, 25, 30})
    html += fmt::format("<option{}>{}</option>", rate == 24 ? " selected" : "", rate);
  return html + "</select></label></div></div>\n";
}

std::string failures(const BatchPage& page) {
  std::string rows;
  for (const PageFrame& frame : page.frames)
    if (frame.status == "failed")
      rows +=
          fmt::format("<tr><td class=\"number\">{}</td><td class=\"number\">{}</td>"
                      "<td class=\"line-text\"><code>{}</code></td></tr>\n",
                      frame.number, frame.exit_code ? std::to_string(*frame.exit_code) : "unknown",
                      html_text(frame.reason));
  if (rows.empty())
    return "";
  return "<h2>Failed frames</h2>\n<p class=\"quiet\">Exit code 2: bad input; rendering again does "
         "not "
         "help. 3: a corrupt file, a full disk or too little memory. 1: a defect in "
         "vdbeam.</p>\n<div class=\"table\"><table><thead><tr><th>frame</th><th>exit code</th>"
         "<th>message</th></tr></thead>\n<tbody>\n" +
         rows + "</tbody></table></div>\n";
}

std::string strip(const BatchPage& page) {
  std::string html = fmt::format(
      "<h2>Frames</h2>\n<div class=\"strip\" style=\"--shape: {:.4f}\">\n", aspect(page));
  for (const PageFrame& frame : page.frames) {
    const std::string status = frame.status.empty() ? "not begun" : frame.status;
    html += "<figure>";
    if (frame.thumbnail.empty())
      html += "<div class=\"empty\"></div>";
    else
      html += fmt::format("<img src=\"{}\" alt=\"frame {}\" loading=\"lazy\">",
                          html_text(frame.thumbnail), frame.number);
    html += fmt::format("<figcaption>{} <span class=\"{}\">{}</span></figcaption></figure>\n",
                        frame.number, html_text(status), html_text(status));
  }
  return html + "</div>\n";
}

/// A row of the facts; long lists of different values fold.
std::string fact(const std::string& name, std::vector<std::string> values, bool code = false) {
  constexpr std::size_t most_shown = 3;
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  std::string list;
  for (const std::string& value : values)
    list += code ? fmt::format("<div><code>{}</code></div>", html_text(value))
                 : fmt::format("<div>{}</div>", html_text(value));
  if (values.size() > most_shown)
    list = fmt::format("<details><summary>{} different</summary>{}</details>", values.size(), list);
  return values.empty() ? "" : fmt::format("<dt>{}</dt><dd>{}</dd>\n", name, list);
}

std::string facts(const BatchPage& page) {
  std::vector<std::string> dates = page.dates;
  if (dates.size() > 1) {
    const auto [first, last] = std::minmax_element(dates.begin(), dates.end());
    dates = {*first == *last ? *first : fmt::format("{} to {}", *first, *last)};
  }
  return "<h2>How it was made</h2>\n<dl>\n" + fact("Scene", {page.scene}) +
         fact("Machine", page.machines) + fact("Version", page.versions) + fact("Date", dates) +
         fact("Command", page.commands, true) + "</dl>\n";
}

/// The scene without its folder; the facts have the whole path.
std::string name_of(const BatchPage& page) {
  return std::filesystem::path(page.scene).filename().string();
}

std::string headline(const BatchPage& page) {
  std::vector<int> numbers;
  for (const PageFrame& frame : page.frames)
    numbers.push_back(frame.number);
  std::string html =
      fmt::format("<h1>{}</h1>\n<p class=\"quiet\">{} ({})", html_text(name_of(page)),
                  count_text(numbers.size(), "frame"), format_frame_range(numbers));
  if (!page.finished)
    html += ". The batch is not finished; this page is replaced after each frame: reload it";
  return html + ".</p>\n";
}

} // namespace

std::optional<double> flicker(const std::vector<PageFrame>& frames) {
  double sum = 0;
  int pairs = 0;
  for (std::size_t i = 1; i < frames.size(); ++i)
    if (!frames[i - 1].thumbnail.empty() && !frames[i].thumbnail.empty()) {
      sum += relative_change(frames[i - 1].picture.brightness, frames[i].picture.brightness);
      ++pairs;
    }
  return pairs > 0 ? std::optional(sum / pairs) : std::nullopt;
}

std::string page_html(const BatchPage& page) {
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
         "<link rel=\"icon\" href=\"data:,\">\n<title>" +
         html_text(name_of(page)) + "</title>\n<style>" + page_style +
         "</style>\n</head>\n<body>\n" + headline(page) + tiles(page) + player(page) +
         failures(page) + charts(page) + strip(page) + facts(page) + "<script>" + page_script +
         "</script>\n</body>\n</html>\n";
}

} // namespace vdbeam
