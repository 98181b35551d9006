#include "python/bindings.h"
#include "report/report.h"
#include "vdbeam/memory_plan.h"
#include "vdbeam/scene_file.h"
#include "vdbeam/volume_file.h"

#include <nlohmann/json.hpp>

namespace vdbeam::python {
namespace {

using Overrides = std::vector<std::string>;
using WithoutLock = py::call_guard<py::gil_scoped_release>;

void write_density(const FloatArray& values, const std::string& path, double voxel_size,
                   const std::array<double, 3>& origin, const std::string& grid) {
  if (values.ndim() != 3)
    throw py::value_error("a density array needs three axes: x, y, z");
  DensityArray density;
  density.values = values.data();
  for (int a = 0; a < 3; ++a)
    density.size[a] = static_cast<int>(values.shape(a));
  density.voxel_size = voxel_size;
  density.origin = {origin[0], origin[1], origin[2]};
  const py::gil_scoped_release unlocked;
  write_volume_file(density, path, grid);
}

} // namespace

void bind_scenes(py::module_& module) {
  py::class_<Scene>(module, "Scene")
      .def_property_readonly("notes", [](const Scene& scene) { return scene.notes; })
      .def_property_readonly("width", [](const Scene& scene) { return scene.image.width; })
      .def_property_readonly("height", [](const Scene& scene) { return scene.image.height; })
      .def("settings", [](const Scene& scene) { return json_text(settings_json(scene)); })
      .def(
          "hash", [](const Scene& scene) { return scene_hash(scene); }, WithoutLock())
      .def(
          "plan",
          [](const Scene& scene, bool pilots) {
            return json_text(plan_json(pilots ? choose_plan(scene) : make_plan(scene)));
          },
          py::arg("pilots"), WithoutLock());
  module.def(
      "load_scene",
      [](const std::string& path, int frame, const Overrides& overrides) {
        return load_scene(path, FrameTime(frame), overrides);
      },
      py::arg("path"), py::arg("frame"), py::arg("overrides"), WithoutLock());
  module.def(
      "parse_scene",
      [](const std::string& text, const std::string& path, int frame, const Overrides& overrides) {
        return parse_scene(text, path, FrameTime(frame), overrides);
      },
      py::arg("text"), py::arg("path"), py::arg("frame"), py::arg("overrides"), WithoutLock());
  module.def("write_density", &write_density, py::arg("values"), py::arg("path"),
             py::arg("voxel_size"), py::arg("origin"), py::arg("grid"));
}

} // namespace vdbeam::python
