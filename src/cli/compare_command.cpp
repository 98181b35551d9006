#include "cli/commands.h"
#include "vdbeam/error.h"
#include "vdbeam/image_file.h"
#include "vdbeam/metrics.h"

#include <cstdio>
#include <fmt/format.h>
#include <memory>
#include <nlohmann/json.hpp>

namespace vdbeam::cli {
namespace {

struct CompareOptions {
  std::string image, reference;
  bool json = false;
};

int run_compare(const CompareOptions& options) {
  const Image image = read_image(options.image), reference = read_image(options.reference);
  ImageError error;
  try {
    error = compare_images(image, reference);
  } catch (const InputError& problem) {
    throw InputError(
        fmt::format("{} and {}: {}", options.image, options.reference, problem.what()));
  }
  if (options.json) {
    const nlohmann::ordered_json json{{"image", options.image}, {"reference", options.reference},
                                      {"rmse", error.rmse},     {"mrse", error.mrse},
                                      {"relmse", error.relmse}, {"bias", error.bias},
                                      {"flip", error.flip}};
    using Handler = nlohmann::ordered_json::error_handler_t;
    fmt::print("{}\n", json.dump(2, ' ', false, Handler::replace));
    return 0;
  }
  fmt::print("RMSE    {:.6g}\nMRSE    {:.6g}\nrelMSE  {:.6g}\nbias    {:+.4f} %\nFLIP    {:.6g}\n",
             error.rmse, error.mrse, error.relmse, 100 * error.bias, error.flip);
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
  app.add_flag("--json", options->json, "Print JSON");
  app.footer(R"(In linear RGB, v the image and r the reference:
  RMSE    sqrt(mean((v - r)^2))
  MRSE    mean((v - r)^2 / (r + 0.01)^2)
  relMSE  mean((v - r)^2 / (r^2 + 0.01)) without the worst 0.1 % of pixels
  bias    mean(v) / mean(r) - 1
  FLIP    mean FLIP difference at 67 pixels per degree

Examples:
  vdbeam compare cloud.exr reference.exr
  vdbeam compare cloud.exr reference.exr --json)");
  return [options] { return run_compare(*options); };
}

} // namespace vdbeam::cli
