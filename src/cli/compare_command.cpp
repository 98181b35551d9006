#include "cli/commands.h"
#include "console/streams.h"
#include "image/color_conversion.h"
#include "report/report.h"
#include "text/frame_range.h"
#include "text/text.h"
#include "vdbeam/error.h"
#include "vdbeam/image_file.h"
#include "vdbeam/metrics.h"

#include <fmt/format.h>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

namespace vdbeam::cli {
namespace {

/// What the metrics are defined for.
Image read_in_rec709(const std::string& path) {
  Image image = read_image(path);
  convert_colors(image, {});
  return image;
}

using Json = nlohmann::ordered_json;

struct CompareOptions {
  std::string image, reference, second, frames;
  bool json = false;
};

/// A frame and its reference.
struct Pair {
  Image image, reference;
};

/// Errors about a pair name both files.
template <class F>
auto naming(const std::string& image, const std::string& reference, F&& compare) {
  try {
    return compare();
  } catch (const InputError& problem) {
    throw InputError(fmt::format("{} and {}: {}", image, reference, problem.what()));
  }
}

void add_error(Json& json, const ImageError& error) {
  json["rmse"] = error.rmse;
  json["mrse"] = error.mrse;
  json["relmse"] = error.relmse;
  json["bias"] = error.bias;
  json["flip"] = error.flip;
}

std::string error_text(const ImageError& error) {
  return fmt::format(
      "RMSE    {:.6g}\nMRSE    {:.6g}\nrelMSE  {:.6g}\nbias    {:+.4f} %\nFLIP    {:.6g}\n",
      error.rmse, error.mrse, error.relmse, 100 * error.bias, error.flip);
}

/// Against two noisy references: free of their noise.
int compare_with_two(const CompareOptions& options) {
  const Image image = read_in_rec709(options.image), reference = read_in_rec709(options.reference),
              second = read_in_rec709(options.second);
  const ImageError error = naming(options.image, options.reference,
                                  [&] { return image_error(image, reference, second); });
  const std::string text =
      fmt::format("free of the references' noise:\n"
                  "RMSE    {:.6g}\nMRSE    {:.6g}, standard error {:.2g}\nrelMSE  {:.6g}\n"
                  "bias    {:+.4f} %\n",
                  error.rmse, error.mrse, error.mrse_error, error.relmse, 100 * error.bias);
  const Json json{{"image", options.image},   {"reference", options.reference},
                  {"second", options.second}, {"rmse", error.rmse},
                  {"mrse", error.mrse},       {"mrse_error", error.mrse_error},
                  {"relmse", error.relmse},   {"bias", error.bias}};
  options.json ? print_output(json_text(json)) : print_text(text);
  return 0;
}

int compare_stills(const CompareOptions& options) {
  const Image image = read_in_rec709(options.image), reference = read_in_rec709(options.reference);
  const ImageError error =
      naming(options.image, options.reference, [&] { return compare_images(image, reference); });
  if (!options.json) {
    print_text(error_text(error));
    return 0;
  }
  Json json{{"image", options.image}, {"reference", options.reference}};
  add_error(json, error);
  print_output(json_text(json));
  return 0;
}

/// Means over the frames, and how the frames' errors change from one to the next.
class SequenceErrors {
public:
  explicit SequenceErrors(const CompareOptions& options) : options_(options) {}

  void add(int frame) {
    const std::string image = substitute_frame(options_.image, frame);
    const std::string reference = substitute_frame(options_.reference, frame);
    Pair pair{read_in_rec709(image), read_in_rec709(reference)};
    const ImageError error =
        naming(image, reference, [&] { return compare_images(pair.image, pair.reference); });
    Json entry{{"frame", frame}};
    add_error(entry, error);
    if (last_) {
      const double temporal = naming(image, reference, [&] {
        return temporal_error(last_->image, pair.image, last_->reference, pair.reference);
      });
      entry["temporal"] = temporal;
      temporal_ += temporal;
    }
    frames_.push_back(std::move(entry));
    sum_.rmse += error.rmse;
    sum_.mrse += error.mrse;
    sum_.relmse += error.relmse;
    sum_.bias += error.bias;
    sum_.flip += error.flip;
    last_ = std::move(pair);
  }

  void print() const {
    const double count = static_cast<double>(frames_.size());
    const ImageError mean{sum_.rmse / count, sum_.mrse / count, sum_.relmse / count,
                          sum_.bias / count, sum_.flip / count};
    const double temporal = temporal_ / (count - 1);
    if (!options_.json) {
      print_text(fmt::format("means of {} frames:\n{}temporal error    {:.6g}\n", frames_.size(),
                             error_text(mean), temporal));
      return;
    }
    Json json{{"image", options_.image}, {"reference", options_.reference}};
    add_error(json, mean);
    json["temporal"] = temporal;
    json["frames"] = frames_;
    print_output(json_text(json));
  }

private:
  const CompareOptions& options_;
  Json frames_ = Json::array();
  ImageError sum_;
  double temporal_ = 0;
  std::optional<Pair> last_;
};

int compare_sequences(const CompareOptions& options) {
  std::vector<int> frames;
  try {
    frames = parse_frame_range(options.frames);
  } catch (const InputError& error) {
    throw InputError(one_line(fmt::format("--frames: {}", error.what())));
  }
  if (frames.size() < 2)
    throw InputError("--frames: a sequence has at least two frames; leave it out for a still");
  for (const std::string& path : {options.image, options.reference})
    if (!has_frame_pattern(path))
      throw InputError(one_line(path + ": has no place for a frame number, like a.####.exr"));
  SequenceErrors errors(options);
  for (const int frame : frames)
    errors.add(frame);
  errors.print();
  return 0;
}

} // namespace

CommandRun add_compare(CLI::App& app) {
  const auto options = std::make_shared<CompareOptions>();
  app.add_option("image", options->image, "Image to judge (.exr or .hdr)")
      ->required()
      ->option_text("IMAGE");
  app.add_option("reference", options->reference, "The true image")
      ->required()
      ->option_text("REFERENCE");
  app.add_option("--second", options->second,
                 "A second, independent reference: removes the references' noise from the errors")
      ->option_text("REFERENCE");
  app.add_option("-f,--frames", options->frames,
                 "Compare these frames of two sequences (a.####.exr)")
      ->option_text("RANGE");
  app.add_flag("--json", options->json, "Print JSON");
  app.footer(R"(In linear RGB, v the image and r the reference:
  RMSE    sqrt(mean((v - r)^2))
  MRSE    mean((v - r)^2 / (r + 0.01)^2)
  relMSE  mean((v - r)^2 / (r^2 + 0.01)) without the worst 0.1 % of pixels
  bias    mean(v) / mean(r) - 1
  FLIP    mean FLIP difference at 67 pixels per degree
With a second reference, independent of the first and unbiased like it (two renders by path with
other seeds), products (v - a)(v - b) take the place of squares, so that their noise does not count.
The standard error says how far to trust the MRSE; fireflies in the references increase it.
Of a sequence the means over its frames, and its temporal error, what one sees as flicker:
  mean((dv - dr)^2 / (r + 0.01)^2), dv and dr the change from one frame to the next, r the mean of
  both references. Frames whose noise is independent have twice their MRSE.

Examples:
  vdbeam compare cloud.exr reference.exr
  vdbeam compare cloud.exr reference.exr --json
  vdbeam compare cloud.exr path_seed1.exr --second path_seed2.exr
  vdbeam compare smoke.####.exr truth.####.exr -f 1-24)");
  return [options] {
    if (!options->second.empty() && !options->frames.empty())
      throw InputError("--second is for stills, --frames for sequences: give one of them");
    if (!options->second.empty())
      return compare_with_two(*options);
    return options->frames.empty() ? compare_stills(*options) : compare_sequences(*options);
  };
}

} // namespace vdbeam::cli
