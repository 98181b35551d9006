#include "keys/key_synonyms.h"

#include "text/text.h"

#include <gtest/gtest.h>
#include <set>
#include <sstream>

namespace vdbeam {
namespace {

/// The key of a table, or of another where the name has a table before it.
const SceneKey* key_of(SceneSection section, const std::string& name) {
  const std::size_t dot = name.rfind('.');
  if (dot == std::string::npos)
    return find_key(section, name);
  for (const SceneSection other : scene_sections()) {
    const std::string table = section_name(other);
    if (table == name.substr(0, dot) || table == section_name(section) + "." + name.substr(0, dot))
      return find_key(other, name.substr(dot + 1));
  }
  return nullptr;
}

TEST(KeySynonyms, LeadToKeysThatThereAre) {
  for (const KeySynonym& synonym : key_synonyms()) {
    std::istringstream keys{std::string(synonym.keys)};
    std::size_t count = 0;
    for (std::string key; keys >> key; ++count)
      EXPECT_NE(key_of(synonym.section, key), nullptr) << synonym.word << " -> " << key;
    EXPECT_TRUE(count > 0 || !synonym.remedy.empty()) << synonym.word;
  }
}

TEST(KeySynonyms, AreNoKeysAndAreThereOnce) {
  std::set<std::string> seen;
  for (const KeySynonym& synonym : key_synonyms()) {
    const std::string word(synonym.word);
    EXPECT_EQ(find_key(synonym.section, word), nullptr) << word;
    EXPECT_EQ(word, lower_case(word));
    EXPECT_TRUE(seen.insert(section_name(synonym.section) + "." + word).second) << word;
  }
}

TEST(KeySynonyms, OfValuesLeadToValuesThatThereAre) {
  for (const ValueSynonym& synonym : value_synonyms()) {
    const SceneKey* const key = find_key(synonym.section, std::string(synonym.key));
    ASSERT_NE(key, nullptr) << synonym.key;
    const std::set<std::string> choices(key->choices.begin(), key->choices.end());
    EXPECT_FALSE(choices.contains(std::string(synonym.word))) << synonym.word;
    EXPECT_TRUE(synonym.value.empty() ? !synonym.remedy.empty()
                                      : choices.contains(std::string(synonym.value)))
        << synonym.word;
  }
}

TEST(KeySynonyms, OfOptions) {
  EXPECT_EQ(key_meant_by("samples"), "render.passes");
  EXPECT_EQ(key_meant_by("size"), "image.width");
  EXPECT_EQ(key_meant_by("nonsense"), "");
}

TEST(KeyTables, FitTheirWidth) {
  for (const std::size_t width : {80u, 100u, 120u}) {
    std::istringstream lines(key_tables_text(width));
    for (std::string line; std::getline(lines, line);)
      if (line.find(' ', 20) != std::string::npos) { // more than one long word
        EXPECT_LE(line.size(), width) << line;
      }
  }
}

} // namespace
} // namespace vdbeam
