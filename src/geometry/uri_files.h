#pragma once

namespace Assimp {
class Importer;
}

namespace vdbeam {

/// Lets an importer open the files that a glTF names by URIs, in which a space is %20: assimp takes
/// them for names of files.
void open_uris(Assimp::Importer& importer);

} // namespace vdbeam
