"""The source tree keeps its rules, and the check of the rules can fail."""
import pathlib
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
import check_layout  # noqa: E402


def messages(path, text):
    return [message for _, message in check_layout.check_file(pathlib.PurePosixPath(path), text)]


class Tree(unittest.TestCase):
    def test_has_no_violation(self):
        self.assertEqual(check_layout.check_tree(ROOT), [])

    def test_lists_every_folder_of_src(self):
        folders = {folder.name for folder in (ROOT / "src").iterdir() if folder.is_dir()}
        self.assertLessEqual(folders, set(check_layout.LAYERS))


class Checker(unittest.TestCase):
    def refuses(self, path, text, part):
        found = messages(path, text)
        self.assertTrue(any(part in message for message in found), found)

    def accepts(self, path, text):
        self.assertEqual(messages(path, text), [])

    def test_direction_of_includes(self):
        self.refuses("src/math/a.cpp", '#include "volume/b.h"\n', "may not include")
        self.refuses("src/volume/a.cpp", '#include "b.h"\n', "folder/file.h")
        self.refuses("src/other/a.cpp", '#include "math/b.h"\n', "not in the list")
        self.accepts("src/volume/a.cpp", '#include "math/b.h"\n#include "volume/c.h"\n'
                                         '#include "vdbeam/vec.h"\n#include <vector>\n')

    def test_openvdb_stays_in_vdb_sources(self):
        self.refuses("src/vdb/a.h", "#pragma once\n#include <openvdb/openvdb.h>\n", "OpenVDB")
        self.refuses("src/scene/a.cpp", "#include <openvdb/openvdb.h>\n", "OpenVDB")
        self.accepts("src/vdb/a.cpp", "#include <openvdb/openvdb.h>\n")

    def test_openexr_stays_in_image(self):
        for header in ("ImfHeader.h", "OpenEXR/OpenEXRConfig.h", "Imath/half.h", "half.h"):
            self.refuses("src/film/a.cpp", f"#include <{header}>\n", "OpenEXR")
        self.accepts("src/image/a.cpp", "#include <ImfHeader.h>\n")

    def test_public_headers_know_no_other_library(self):
        self.refuses("include/vdbeam/a.h", "#pragma once\n#include <tbb/task.h>\n", "standard library")
        self.refuses("include/vdbeam/a.h", "#pragma once\n#include \"math/ray.h\"\n", "standard library")
        self.refuses("include/vdbeam/a.h", "#pragma once\nnamespace tbb {}\n", "other library")
        self.accepts("include/vdbeam/a.h", "#pragma once\n#include <vector>\n// OpenVDB, tbb: words\n")

    def test_one_door_for_inputs(self):
        for line in ("std::ifstream file(path);", "std::FILE* f = std::fopen(path, \"r\");", "int d = ::open(path, 0);",
                     "int d = open(path.c_str(), 0);"):
            self.refuses("src/scene/a.cpp", line + "\n", "opened by machine/input_file")
            self.accepts("src/machine/a.cpp", line + "\n")
        self.accepts("src/cli/a.cpp", "const auto scene = options.open();\nSceneDocument open() const;\n")
        opens = "Imf::InputFile file(path.c_str());\n"
        self.refuses("src/image/a.cpp", opens, "has not checked")
        self.accepts("src/image/a.cpp", "check_input_file(path);\n" + opens)

    def test_only_the_program_prints_and_exits(self):
        self.refuses("src/film/a.cpp", 'std::cerr << "x";\n', "prints")
        self.refuses("src/film/a.cpp", 'fmt::print("x");\n', "prints")
        self.refuses("src/film/a.cpp", "std::exit(1);\n", "ends the process")
        self.accepts("src/cli/a.cpp", 'std::printf("x"); std::exit(1);\n')
        self.accepts("src/film/a.cpp", '_exit(0); std::snprintf(b, 9, "std::cout");\n')

    def test_length_and_leftovers(self):
        self.refuses("src/math/a.cpp", "\n" * 401, "limit is 400")
        self.refuses("include/vdbeam/a.h", "#pragma once\n" + "\n" * 150, "limit is 150")
        self.refuses("src/math/a.cpp", "// TO" "DO: later\n", "unfinished")
        self.refuses("src/math/a.h", "int a;\n", "pragma once")
        self.accepts("src/math/a-inl.h", "int a;\n")

    def test_length_of_functions(self):
        def function(lines, indent=""):
            return f"{indent}int f(int a) {{\n" + f"{indent}  g();\n" * (lines - 2) + f"{indent}}}\n"
        self.accepts("src/math/a.cpp", function(60) + function(60))
        self.refuses("src/math/a.cpp", function(2) + function(61), "function of 61 lines")
        method = "class A {\n" + function(61, "  ") + "};\n"
        self.refuses("src/math/a.cpp", method, "function of 61 lines")
        self.accepts("src/keys/a.cpp", function(61))
        self.accepts("src/math/a.cpp", "constexpr Row rows[] = {\n" + "    {f(1), 2},\n" * 80 + "};\n")

    def test_parameters_of_functions(self):
        def function(count):
            return "int f(" + ",\n      ".join(["std::map<int, int> a = {1, 2}"] * count) + ") const {\n}\n"
        self.accepts("src/math/a.cpp", function(7))
        self.refuses("src/math/a.cpp", function(8), "function of 8 parameters")
        self.accepts("src/math/a.cpp", "int f() {\n  for (int i = 0; i < g(1, 2, 3, 4, 5, 6, 7, 8);\n       ++i) {\n  }\n}\n")

    def test_number_of_files(self):
        def fill(folder, count):
            folder.mkdir(parents=True)
            for number in range(count):
                (folder / f"{number}.cpp").touch()

        with tempfile.TemporaryDirectory() as name:
            root = pathlib.Path(name)
            fill(root / "src/math", 41)
            fill(root / "src/rays", 21)
            fill(root / "src/estimators/beam", 15)
            fill(root / "src/estimators/path", 16)
            self.assertEqual(list(check_layout.check_folders(root)),
                             ["src/math:1: 41 files, the limit is 40", "src/rays:1: 21 files, the limit is 20",
                              "src/estimators:1: 31 files in all, the limit is 30"])


if __name__ == "__main__":
    unittest.main()
