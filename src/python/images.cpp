#include "python/bindings.h"
#include "vdbeam/image_file.h"
#include "vdbeam/metrics.h"

namespace vdbeam::python {
namespace {

py::dict errors_of(const ImageError& error, bool two_references) {
  py::dict result;
  result["rmse"] = error.rmse;
  result["mrse"] = error.mrse;
  result["relmse"] = error.relmse;
  result["bias"] = error.bias;
  if (two_references)
    result["mrse_error"] = error.mrse_error;
  else
    result["flip"] = error.flip;
  return result;
}

py::dict compare(const FloatArray& rgb, const FloatArray& reference,
                 const std::optional<FloatArray>& second) {
  const Image image = image_of(rgb), a = image_of(reference);
  const std::optional<Image> b = second ? std::optional(image_of(*second)) : std::nullopt;
  ImageError error;
  {
    const py::gil_scoped_release unlocked;
    error = b ? image_error(image, a, *b) : compare_images(image, a);
  }
  return errors_of(error, b.has_value());
}

} // namespace

py::dict planes_of(Image& image, const py::object& owner) {
  py::dict planes;
  for (ImageChannel& channel : image.channels)
    planes[py::str(channel.name)] =
        py::array_t<float>({image.height, image.width}, channel.data.data(), owner);
  return planes;
}

Image image_of(const FloatArray& rgb) {
  if (rgb.ndim() != 3 || rgb.shape(2) != 3)
    throw py::value_error("an image needs the shape height, width, 3");
  Image image;
  image.height = static_cast<int>(rgb.shape(0));
  image.width = static_cast<int>(rgb.shape(1));
  const auto pixels = static_cast<std::size_t>(rgb.shape(0) * rgb.shape(1));
  for (std::size_t c = 0; c < 3; ++c) {
    ImageChannel channel{std::string(1, "RGB"[c]), std::vector<float>(pixels), true};
    for (std::size_t i = 0; i < pixels; ++i)
      channel.data[i] = rgb.data()[3 * i + c];
    image.channels.push_back(std::move(channel));
  }
  return image;
}

void bind_images(py::module_& module) {
  py::class_<Image, std::shared_ptr<Image>>(module, "Image")
      .def_property_readonly(
          "planes",
          [](const std::shared_ptr<Image>& image) { return planes_of(*image, py::cast(image)); })
      .def(
          "write_exr", [](const Image& image, const std::string& path) { write_exr(image, path); },
          py::arg("path"))
      .def(
          "write_png",
          [](const Image& image, const std::string& path, double exposure,
             const std::string& view) { write_png(image, path, exposure, view); },
          py::arg("path"), py::arg("exposure"), py::arg("view"));
  module.def(
      "read_image",
      [](const std::string& path) { return std::make_shared<Image>(read_image(path)); },
      py::arg("path"));
  module.def("compare", &compare, py::arg("image"), py::arg("reference"),
             py::arg("second_reference"));
}

} // namespace vdbeam::python
