// Renders a scene through the installed library: downstream SCENE OUT.exr
#include <vdbeam/error.h>
#include <vdbeam/image_file.h>
#include <vdbeam/metrics.h>
#include <vdbeam/render.h>
#include <vdbeam/scene_file.h>
#include <vdbeam/version.h>

#include <cstdio>

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: downstream SCENE OUT.exr\n");
    return 2;
  }
  try {
    const vdbeam::Scene scene = vdbeam::load_scene(
        argv[1], 1,
        {"image.width=32", "image.height=18", "render.passes=1", "render.photons=5000"});
    const vdbeam::RenderResult result = vdbeam::render(scene);
    vdbeam::write_exr(result.image, argv[2]);
    const double error = vdbeam::image_error(vdbeam::read_image(argv[2]), result.image).rmse;
    std::printf("vdbeam %s: %zu pass, written and read back with RMSE %g\n", vdbeam::version(),
                result.passes.size(), error);
    return error < 0.01 ? 0 : 1;
  } catch (const vdbeam::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return static_cast<int>(error.code());
  }
}
