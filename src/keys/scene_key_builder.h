#pragma once

#include "keys/key_access.h"

#include <limits>

namespace vdbeam {

template <class T>
struct Unwrapped {
  using type = T;
};
template <class T>
struct Unwrapped<std::optional<T>> {
  using type = T;
};

template <class T>
constexpr KeyKind kind_of() {
  if constexpr (is_choice<T>)
    return KeyKind::choice;
  else if constexpr (std::is_same_v<T, bool>)
    return KeyKind::boolean;
  else if constexpr (std::is_integral_v<T>)
    return KeyKind::integer;
  else if constexpr (std::is_same_v<T, double>)
    return KeyKind::number;
  else if constexpr (std::is_same_v<T, Vec3d>)
    return KeyKind::vector;
  else if constexpr (std::is_same_v<T, Rgb>)
    return KeyKind::color;
  else if constexpr (std::is_same_v<T, std::string>)
    return KeyKind::text;
  else
    return KeyKind::matrix;
}

/// A key under construction; each call below adds one property.
struct KeyEntry {
  SceneKey key;

  KeyEntry& unit(std::string text) { return set(key.unit, std::move(text)); }
  KeyEntry& kind(KeyKind k) { return set(key.kind, k); }
  KeyEntry& file(InputKind input) { return set(key.kind, KeyKind::file).set(key.input, input); }
  KeyEntry& types(std::vector<std::string> t) { return set(key.types, std::move(t)); }
  KeyEntry& absent(std::string word) { return set(key.absent_word, std::move(word)); }
  KeyEntry& required() { return set(key.required, true); }
  KeyEntry& one_for_all() { return set(key.one_for_all, true); }
  KeyEntry& keeps_picture() { return set(key.changes_picture, false); }
  KeyEntry& not_in_passes() { return set(key.changes_passes, false); }
  KeyEntry& always_written() { return set(key.always_written, true); }
  KeyEntry& keeps_world() { return set(key.changes_world, false); }
  KeyEntry& scales_emission() { return set(key.scales_emission, true); }
  KeyEntry& at_least(double low) { return set(key.range.lower, low); }
  KeyEntry& above(double low) { return at_least(low).set(key.range.lower_open, true); }
  KeyEntry& within(double low, double high) {
    return set(key.range, {.lower = low, .upper = high});
  }
  KeyEntry& inside(double low, double high) {
    return set(key.range, {.lower = low, .upper = high, .lower_open = true, .upper_open = true});
  }
  KeyEntry& above_up_to(double low, double high) {
    return set(key.range, {.lower = low, .upper = high, .lower_open = true});
  }

private:
  template <class T>
  KeyEntry& set(T& field, T value) {
    field = std::move(value);
    return *this;
  }
};

/// Collects the keys of a scene file, section by section.
class KeyTable {
public:
  explicit KeyTable(std::vector<KeyEntry>& entries) : entries_(entries) { entries_.reserve(64); }

  void section(SceneSection s) { section_ = s; }

  template <class S, class T>
  KeyEntry& add(const char* name, T S::*member, const char* doc) {
    KeyEntry& entry = add_unbound<typename Unwrapped<T>::type>(name, doc);
    bind_member(entry.key, member);
    return entry;
  }
  /// A number whose 0 is written "auto".
  template <class S, class T>
  KeyEntry& add_auto(const char* name, T S::*member, const char* doc) {
    KeyEntry& entry = add_unbound<T>(name, doc);
    bind_member_zero_is_absent(entry.key, member);
    return entry.absent("auto");
  }
  template <class T>
  KeyEntry& add_unbound(const char* name, const char* doc) {
    KeyEntry& entry = entries_.emplace_back();
    entry.key.section = section_;
    entry.key.name = name;
    entry.key.doc = doc;
    entry.key.kind = kind_of<T>();
    if constexpr (is_choice<T>)
      entry.key.choices = choice_names<T>();
    if constexpr (is_kind<T>)
      entry.key.choice_docs = kind_docs<T>();
    entry.key.one_for_all = entry.key.kind == KeyKind::color;
    if constexpr (std::is_integral_v<T>)
      entry.key.range.upper = static_cast<double>(std::numeric_limits<T>::max());
    return entry;
  }

private:
  std::vector<KeyEntry>& entries_;
  SceneSection section_ = SceneSection::image;
};

void add_image_keys(KeyTable& table);
void add_camera_keys(KeyTable& table);
void add_instance_keys(KeyTable& table);
void add_light_keys(KeyTable& table);
void add_material_keys(KeyTable& table);

} // namespace vdbeam
