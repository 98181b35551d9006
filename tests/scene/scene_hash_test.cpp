#include "keys/scene_keys.h"
#include "scene/content_hash.h"
#include "scene_fixture.h"

#include <set>

namespace vdbeam {
namespace {

using SceneHash = test::SceneTest;

const char* const text =
    "[[volume]]\nfile = 'cloud.vdb'\n[[light]]\ntype = 'environment'\n"
    "[[mesh]]\ntype = 'quad'\n[[layer]]\nname = 'depth'\n[render]\nestimator = 'path'\n";

TEST_F(SceneHash, IsSixteenHexDigitsAndStable) {
  const std::string hash = scene_hash(load(text));
  EXPECT_EQ(hash.size(), 16u);
  EXPECT_EQ(hash.find_first_not_of("0123456789abcdef"), std::string::npos);
  EXPECT_EQ(scene_hash(load(text)), hash);
}

TEST_F(SceneHash, EveryKeyThatChangesThePictureChangesIt) {
  Scene scene = load(text);
  scene.instances.emplace_back();
  std::set<std::string> hashes{scene_hash(scene)};
  std::size_t changes = 0;
  for (const SceneKey& key : scene_keys()) {
    if (!key.get || key.kind == KeyKind::file)
      continue;
    Scene changed = scene;
    KeyValue value = key.get(scene, 0);
    if (auto* list = std::get_if<std::vector<double>>(&value))
      list->back() += 0.125;
    else if (auto* number = std::get_if<double>(&value))
      *number += 0.125;
    else if (auto* whole = std::get_if<std::int64_t>(&value))
      *whole = key.kind == KeyKind::boolean ? 1 - *whole : *whole + 1;
    else if (key.kind == KeyKind::choice)
      value = value == KeyValue(key.choices[0]) ? key.choices[1] : key.choices[0];
    else if (key.kind == KeyKind::text)
      value = std::string("other");
    else if (key.kind == KeyKind::vector || key.kind == KeyKind::color)
      value = std::vector<double>{1, 2, 3};
    else if (key.kind == KeyKind::integer)
      value = std::int64_t{5};
    else
      value = 5.0;
    key.set(changed, 0, value);
    changes += key.changes_picture ? 1 : 0;
    hashes.insert(scene_hash(changed));
    EXPECT_EQ(scene_hash(changed) != scene_hash(scene), key.changes_picture) << key_path(key, 0);
  }
  EXPECT_EQ(hashes.size(), changes + 1); // all of them differ from each other too
}

TEST_F(SceneHash, NamesAndThreadsDoNotChangeIt) {
  const std::string hash = scene_hash(load(text));
  write("copy.vdb", " BDV first");
  EXPECT_EQ(scene_hash(load("# comment\n" + std::string(text),
                            {"render.threads=3", "volume.0.file=" + file("copy.vdb")})),
            hash);
}

TEST_F(SceneHash, ContentsOfTheVolumeChangeIt) {
  const std::string hash = scene_hash(load(text));
  write("cloud.vdb", " BDV First");
  EXPECT_NE(scene_hash(load(text)), hash);
}

TEST_F(SceneHash, ContentsOfAMeshChangeIt) {
  const std::string mesh = "[[mesh]]\nfile = 'rock.obj'\n[render]\nestimator = 'path'\n";
  write("rock.obj", "first");
  const std::string hash = scene_hash(load(mesh));
  write("rock.obj", "other");
  EXPECT_NE(scene_hash(load(mesh)), hash);
}

TEST_F(SceneHash, OrderOfVolumesCounts) {
  const std::string a = "{ file = 'cloud.vdb', extinction = 1 }",
                    b = "{ file = 'cloud.vdb', extinction = 2 }";
  EXPECT_NE(scene_hash(load("volume = [" + a + "," + b + "]")),
            scene_hash(load("volume = [" + b + "," + a + "]")));
}

TEST(ContentHash, DoesNotDependOnHowTheBytesArrive) {
  std::string bytes;
  for (int i = 0; i < 1000; ++i)
    bytes += static_cast<char>(i * 7);
  ContentHash whole;
  whole.add(bytes.data(), bytes.size());
  for (const std::size_t step : {1, 7, 31, 32, 33, 100}) {
    ContentHash parts;
    for (std::size_t i = 0; i < bytes.size(); i += step)
      parts.add(bytes.data() + i, std::min(step, bytes.size() - i));
    EXPECT_EQ(parts.value(), whole.value()) << step;
  }
}

TEST(ContentHash, SmallChangesAndLengthsDiffer) {
  std::set<std::uint64_t> values;
  std::size_t count = 0;
  for (std::size_t size = 0; size <= 100; ++size)
    for (int bit = -1; bit < static_cast<int>(8 * size); ++bit, ++count) {
      std::string bytes(size, '\0');
      if (bit >= 0)
        bytes[static_cast<std::size_t>(bit) / 8] = static_cast<char>(1 << (bit % 8));
      ContentHash hash;
      hash.add(bytes.data(), bytes.size());
      values.insert(hash.value());
    }
  EXPECT_EQ(values.size(), count);
}

} // namespace
} // namespace vdbeam
