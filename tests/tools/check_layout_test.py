"""The source tree keeps its rules, and the check of the rules can fail."""
import pathlib
import sys
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


if __name__ == "__main__":
    unittest.main()
