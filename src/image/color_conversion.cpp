#include "image/color_conversion.h"

#include "machine/input_file.h"
#include "text/text.h"
#include "vdbeam/error.h"

#include <OpenColorIO/OpenColorIO.h>
#include <fmt/format.h>

#include <cstdlib>
#include <optional>

namespace vdbeam {
namespace {

namespace ocio = OCIO_NAMESPACE;

/// Calls visit(r, g, b) with the planes of each layer that has colours.
template <class Visit>
void for_each_color(Image& image, const Visit& visit) {
  for (std::size_t i = 0; i < image.channels.size(); ++i) {
    const std::string& red = image.channels[i].name;
    if (!(red == "R" || red.ends_with(".R")) || red.starts_with("variance") ||
        red.starts_with("error.") || red.starts_with("shadow.") || red.starts_with("CryptoObject"))
      continue;
    const std::string layer = red.substr(0, red.size() - 1);
    std::vector<float>* planes[3] = {&image.channels[i].data, nullptr, nullptr};
    for (ImageChannel& channel : image.channels) {
      if (channel.name == layer + "G")
        planes[1] = &channel.data;
      if (channel.name == layer + "B")
        planes[2] = &channel.data;
    }
    if (planes[1] && planes[2])
      visit(*planes[0], *planes[1], *planes[2]);
  }
}

constexpr std::pair<const char*, ColorSpace> known_spaces[] = {
    {"rec709", ColorSpace::rec709},
    {"rec2020", ColorSpace::rec2020},
    {"acescg", ColorSpace::acescg},
    {"aces2065_1", ColorSpace::aces2065_1}};

std::optional<ColorSpace> known_space(const std::string& name) {
  for (const auto& [known, space] : known_spaces)
    if (name == known)
      return space;
  return std::nullopt;
}

/// Suggestion for an unknown colour space: one of ours or of a configuration, if any.
std::string suggestion(const std::string& name, const ocio::ConstConfigRcPtr& config) {
  std::vector<std::string> names;
  for (const auto& [known, space] : known_spaces)
    names.emplace_back(known);
  for (int i = 0; config && i < config->getNumColorSpaces(); ++i)
    names.emplace_back(config->getColorSpaceNameByIndex(i));
  const auto near = nearest_word(name, names);
  return near ? fmt::format("; did you mean {}?", one_line(*near)) : "";
}

/// Refuses a file that OpenColorIO would wait for. "ocio://..." is one that it brings with it.
void check_configuration(const std::string& name, const std::string& file) {
  if (file.starts_with("ocio://"))
    return;
  try {
    check_input_file(file, EmptyFile::accepted);
  } catch (const InputError& problem) {
    throw InputError(
        fmt::format("is \"{}\", but the configuration that OCIO names cannot be read: {}", name,
                    problem.what()));
  }
}

/// From scene-linear ACES2065-1 to a colour space of the configuration.
ocio::ConstCPUProcessorRcPtr make_processor(const std::string& name) {
  const char* file = std::getenv("OCIO");
  if (!file || !*file)
    throw InputError(fmt::format("must be rec709, rec2020, acescg or aces2065_1, or a colour space "
                                 "of the OpenColorIO configuration that the environment variable "
                                 "OCIO names, which is not set; got \"{}\"{}",
                                 name, suggestion(name, nullptr)));
  check_configuration(name, file);
  try {
    const ocio::ConstConfigRcPtr config = ocio::Config::CreateFromFile(file);
    if (!config->getColorSpace(name.c_str()))
      throw InputError(fmt::format("must be a colour space of {}, got \"{}\"{}", file, name,
                                   suggestion(name, config)));
    return config->getProcessor("aces_interchange", name.c_str())->getDefaultCPUProcessor();
  } catch (const ocio::Exception& problem) {
    throw InputError(
        fmt::format("is \"{}\", which {} does not give: {}", name, file, one_line(problem.what())));
  }
}

void convert_by_configuration(Image& image, const std::string& name) {
  const ocio::ConstCPUProcessorRcPtr processor = make_processor(name);
  convert_colors(image, chromaticities_of(ColorSpace::aces2065_1));
  for_each_color(image, [&](std::vector<float>& r, std::vector<float>& g, std::vector<float>& b) {
    ocio::PlanarImageDesc planes(r.data(), g.data(), b.data(), nullptr, image.width, image.height);
    processor->apply(planes);
  });
  image.primaries.reset();
  image.metadata["vdbeam:colorSpace"] = name;
}

} // namespace

void convert_colors(Image& image, const Chromaticities& primaries) {
  if (!image.primaries || image.primaries->is_near(primaries))
    return;
  const ColorMatrix matrix = rgb_matrix(*image.primaries, primaries);
  for_each_color(image, [&](std::vector<float>& r, std::vector<float>& g, std::vector<float>& b) {
    for (std::size_t i = 0; i < r.size(); ++i) {
      const Vec3d c = matrix.apply({double{r[i]}, double{g[i]}, double{b[i]}});
      r[i] = static_cast<float>(c.x);
      g[i] = static_cast<float>(c.y);
      b[i] = static_cast<float>(c.z);
    }
  });
  image.primaries = primaries;
}

void convert_to_output_space(Image& image, const std::string& name) {
  if (const auto space = known_space(name))
    convert_colors(image, chromaticities_of(*space));
  else
    convert_by_configuration(image, name);
}

std::string why_no_output_space(const std::string& name) {
  if (name.empty() || known_space(name))
    return "";
  try {
    make_processor(name);
    return "";
  } catch (const InputError& problem) {
    return problem.what();
  }
}

} // namespace vdbeam
