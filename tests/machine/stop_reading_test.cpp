// All that a thread reads ends where its token says so; each of these readers would go on to the
// end of its file.
#include "machine/stop_reading.h"

#include "geometry/mesh_reader.h"
#include "geometry/surface_set.h"
#include "machine/guarded_process.h"
#include "prepare/prepared_scene.h"
#include "scene/content_hash.h"
#include "support/temp_folder.h"
#include "vdb/vdb_reader.h"
#include "vdbeam/error.h"
#include "vdbeam/image_file.h"
#include "vdbeam/memory_plan.h"
#include "vdbeam/scene_file.h"

#include <gtest/gtest.h>

#include <thread>
#include <unistd.h>

namespace vdbeam {
namespace {

using test::TempFolder;
using test::write_bytes;

class Stopping : public testing::Test {
protected:
  std::string file(const std::string& name, const std::string& text) {
    write_bytes(folder_.file(name), text);
    return folder_.file(name);
  }
  std::string picture() {
    Image image;
    image.width = image.height = 8;
    for (const char* name : {"R", "G", "B"})
      image.channels.push_back({name, std::vector<float>(64, 0.5f)});
    write_exr(image, folder_.file("picture.exr"));
    return folder_.file("picture.exr");
  }
  std::string triangle() { return file("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"); }

  const std::atomic<bool> yes_ = true;
  const StopToken stop_{&yes_};
  TempFolder folder_;
};

TEST_F(Stopping, EndsEveryReader) {
  const std::string image = picture(), mesh = triangle();
  const std::string volume = VDBEAM_SOURCE_DIR "/data/fog.vdb";
  const StopReading reading(stop_);
  GuardLimits limits;
  limits.bytes = 1 << 20;
  EXPECT_THROW(run_guarded("label", limits, [](int) { pause(); }), Stopped);
  EXPECT_THROW(read_image(image), Stopped);
  EXPECT_THROW(read_mesh(mesh), Stopped);
  EXPECT_THROW(read_density_grid(volume, "density"), Stopped);
  EXPECT_THROW(hash_file(image), Stopped);
}

TEST_F(Stopping, EndsPlansAndPreparations) {
  const std::string image = picture(), mesh = triangle();
  const auto scene_with = [&](const std::string& text) {
    return load_scene(file("s.toml", text + "[[light]]\ntype = 'distant'\n"));
  };
  const Scene meshes = scene_with("[[mesh]]\nfile = 'a.obj'\n");
  const Scene textures = scene_with("[[mesh]]\ntype = 'quad'\nmaterial = { type = 'diffuse', "
                                    "texture = 'picture.exr' }\n");
  const Scene skies = scene_with("[[light]]\ntype = 'environment'\nimage = 'picture.exr'\n");
  for (const Scene& scene : {meshes, textures, skies})
    EXPECT_THROW(prepare_scene(scene, nullptr, stop_), Stopped);
  const StopReading reading(stop_);
  EXPECT_THROW(plan_memory(meshes), Stopped);
  EXPECT_THROW(plan_memory(textures), Stopped);
}

/// Embree's trees; what ended one leaves no error for the next.
TEST_F(Stopping, EndsTreesOverSurfaces) {
  const auto sphere = make_simple_shape(SurfaceShape::sphere);
  const SurfaceSet first({{sphere, {}}}, 1);
  {
    const StopReading reading(stop_);
    EXPECT_THROW(SurfaceSet({{make_simple_shape(SurfaceShape::quad), {}}}, 1, &first), Stopped);
  }
  const SurfaceSet next({{make_simple_shape(SurfaceShape::quad), {}}}, 1, &first);
  EXPECT_EQ(next.size(), 1u);
}

TEST_F(Stopping, IsTheThreadsOwnAndEndsWithItsScope) {
  const std::string image = picture();
  {
    const StopReading reading(stop_);
    const StopToken never;
    {
      const StopReading inner(never);
      EXPECT_NO_THROW(read_image(image));
    }
    EXPECT_THROW(read_image(image), Stopped);
    std::thread([&] { EXPECT_NO_THROW(read_image(image)); }).join();
  }
  EXPECT_NO_THROW(read_image(image));
  EXPECT_EQ(StopReading::token(), nullptr);
}

} // namespace
} // namespace vdbeam
