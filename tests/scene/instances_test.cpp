#include "scene/instances/instance_table.h"
#include "scene_fixture.h"

#include <cmath>

namespace vdbeam {
namespace {

using Transform = std::array<double, 12>;

Transform at(double x, double y, double z) {
  return {1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z};
}

class Instances : public test::SceneTest {
protected:
  const std::string puff_ = "[[volume]]\nfile = 'cloud.vdb'\nname = 'puff'\nextinction = 2\n"
                            "translate = [0, 1, 0]\n"
                            "[[volume]]\nfile = 'cloud.vdb'\nextinction = 7\n";
};

/// The first takes the volume's number, so that those of the others stay.
TEST_F(Instances, RowsOfTheScene) {
  const Scene scene =
      load(puff_ + "[[instance]]\nvolume = 'puff'\nrows = [[5, 0, 0], [0, 0, 2.5]]\n");
  ASSERT_EQ(scene.volumes.size(), 3u);
  EXPECT_EQ(scene.volumes[0].transform, at(5, 1, 0)); // after the volume's own
  EXPECT_EQ(scene.volumes[1].extinction, 7);
  EXPECT_EQ(scene.volumes[1].transform, at(0, 0, 0));
  EXPECT_EQ(scene.volumes[2].transform, at(0, 1, 2.5));
  EXPECT_EQ(scene.volumes[2].extinction, 2);
  EXPECT_EQ(scene.volumes[2].name, "puff");
  EXPECT_EQ(scene.volumes[2].file, file("cloud.vdb"));
}

TEST_F(Instances, ColumnsSayWhatNumbersMean) {
  const std::string table = puff_ + "[[instance]]\nvolume = 'puff'\n";
  const Scene placed =
      load(table + "rows = [[1, 2, 3, 90, 2, 0.5]]\ncolumns = 'x, y, z, ry, scale, density'\n");
  // A quarter turn about y takes z to x; the volume's own place goes along.
  const Transform turned{0, 0, 2, 1, 0, 2, 0, 4, -2, 0, 0, 3};
  for (std::size_t i = 0; i < 12; ++i)
    EXPECT_NEAR(placed.volumes[0].transform[i], turned[i], 1e-12) << i;
  EXPECT_EQ(placed.volumes[0].extinction, 1);
  const Scene matrix =
      load(table + "rows = [[0, 0, 3, 4, 0, 2, 0, 5, -1, 0, 0, 6]]\n"
                   "columns = 'm00 m01 m02 m03 m10 m11 m12 m13 m20 m21 m22 m23'\n");
  EXPECT_EQ(matrix.volumes[0].transform, (Transform{0, 0, 3, 4, 0, 2, 0, 7, -1, 0, 0, 6}));
  // As the keys of a volume place it.
  const Scene keys = load("[[volume]]\nfile = 'cloud.vdb'\ntranslate = [1, 2, 3]\n"
                          "rotate = [10, 20, 30]\nscale = [1, 2, 3]\n"
                          "[[volume]]\nfile = 'cloud.vdb'\nname = 'a'\n[[instance]]\n"
                          "volume = 'a'\ncolumns = 'sx sy sz rx ry rz x y z'\n"
                          "rows = [[1, 2, 3, 10, 20, 30, 1, 2, 3]]\n");
  EXPECT_EQ(keys.volumes[1].transform, keys.volumes[0].transform);
}

TEST_F(Instances, FilesChangeFromFrameToFrame) {
  write("field.0001.csv", "x, z, density\n1, 2, 1\n# a comment\n3; 4; 0\n");
  write("field.0002.csv", "");
  write("field.0003.csv", "5 6 7\r\n");
  const std::string text = puff_ + "[[instance]]\nvolume = 'puff'\nfile = 'field.####.csv'\n";
  const Scene first = load(text, {}, 1);
  ASSERT_EQ(first.volumes.size(), 3u);
  EXPECT_EQ(first.volumes[0].transform, at(1, 1, 2));
  EXPECT_EQ(first.volumes[2].transform, at(3, 1, 4));
  EXPECT_EQ(first.volumes[2].extinction, 0);
  const Scene none = load(text, {}, 2);
  ASSERT_EQ(none.volumes.size(), 2u);
  EXPECT_FALSE(none.volumes[0].present);
  EXPECT_TRUE(none.volumes[1].present);
  EXPECT_EQ(load(text, {}, 3).volumes[0].transform, at(5, 7, 7));
  EXPECT_NE(scene_hash(first), scene_hash(none));
}

TEST_F(Instances, TablesOfOneVolumeAddUp) {
  const Scene scene = load(puff_ + "[[instance]]\nvolume = 'puff'\nrows = []\n"
                                   "[[instance]]\nvolume = 'puff'\nrows = [[1, 0, 0]]\n"
                                   "[[instance]]\nvolume = 'puff'\nrows = [[2, 0, 0]]\n");
  ASSERT_EQ(scene.volumes.size(), 3u);
  EXPECT_TRUE(scene.volumes[0].present);
  EXPECT_EQ(scene.volumes[0].transform, at(1, 1, 0));
  EXPECT_EQ(scene.volumes[2].transform, at(2, 1, 0));
}

TEST_F(Instances, MistakesHaveFileLineAndKey) {
  const std::string table = puff_ + "[[instance]]\nvolume = 'puff'\n"; // lines 9 and 10
  EXPECT_EQ(error_of(puff_ + "[[instance]]\nvolume = 'pufff'\nrows = []\n"),
            "s.toml:10: instance.0.volume: there is no [[volume]] with name = \"pufff\"; did you "
            "mean puff?");
  EXPECT_EQ(error_of("[[volume]]\nfile = 'cloud.vdb'\n[[instance]]\nvolume = 'a'\nrows = []\n"),
            "s.toml:4: instance.0.volume: there is no [[volume]] with name = \"a\"; give one a "
            "name");
  EXPECT_EQ(error_of(table), "s.toml:10: instance.0 needs rows or a file");
  EXPECT_EQ(error_of(table + "rows = [[1, 2, 3],\n[1, 2]]\n"),
            "s.toml:12: instance.0.rows.1 must hold 3 numbers, one for each column, got 2");
  EXPECT_EQ(error_of(table + "rows = [[1, 'a', 3]]\n"),
            "s.toml:11: instance.0.rows.0 must be a list of numbers, e.g. [1, 0, 2.5], got [1, "
            "\"a\", 3]");
  EXPECT_EQ(
      error_of(table + "rows = 3\n"),
      "s.toml:11: instance.0.rows must be a list of rows, e.g. [[0, 0, 0], [5, 0, 0]], got 3");
  EXPECT_EQ(error_of(table + "rows = [[1]]\ncolumns = 'x scal'\n"),
            "s.toml:12: instance.0.columns has the column \"scal\"; did you mean scale?");
  EXPECT_EQ(error_of(table + "rows = [[1, 0]]\ncolumns = 'x scale'\n"),
            "s.toml:11: instance.0.rows.0 must be invertible (no scale may be 0)");
  EXPECT_EQ(error_of(table + "rows = [[1, -1]]\ncolumns = 'x density'\n"),
            "s.toml:11: instance.0.rows.0 must have a density of at least 0, got -1");
  EXPECT_EQ(error_of(table + "rows = []\ncolumns = 'x m00'\n"),
            "s.toml:12: instance.0.columns must have all of m00 to m23 and no other place, or none "
            "of them");
  EXPECT_EQ(error_of(table + "rows = []\ncolumns = 'x x'\n"),
            "s.toml:12: instance.0.columns has the column x twice");
  write("a.csv", "x y z\n1 2 3\n\n1 2 nan\n");
  EXPECT_EQ(error_of(table + "file = 'a.csv'\n"),
            "s.toml:11: instance.0.file: a.csv:4: must hold finite numbers and nothing else");
  EXPECT_EQ(error_of(table + "file = 'a.csv'\nrows = [[0, 0, 0]]\n"),
            "s.toml:10: instance.0 needs rows or a file, not both");
  EXPECT_NE(
      error_of(table + "file = 'b.csv'\n").find("s.toml:11: instance.0.file: there is no file"),
      std::string::npos);
  EXPECT_NE(error_of(table + "row = []\n").find("did you mean rows?"), std::string::npos);
  EXPECT_NE(error_of("[instance]\nvolume = 'a'\n").find("write [[instance]]"), std::string::npos);
}

TEST_F(Instances, CommandLinesChangeThem) {
  const std::string table = puff_ + "[[instance]]\nvolume = 'puff'\nrows = [[1, 0, 0]]\n";
  EXPECT_EQ(load(table, {"instance.0.rows=[[4, 0, 0], [5, 0, 0]]"}).volumes.size(), 3u);
  EXPECT_EQ(load(table, {"instance.columns=z x y"}).volumes[0].transform, at(0, 1, 1));
}

} // namespace
} // namespace vdbeam
