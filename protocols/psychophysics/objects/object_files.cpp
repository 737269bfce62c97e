#include "protocols/psychophysics/objects/object_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <variant>

#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/base/fnv.h"
#include "core/contact/renderer_kinds.h"
#include "core/record/read/session_reader.h"
#include "core/scene/needed_damping.h"

namespace haptrial::protocols {

std::vector<record::ObjectFileRow> object_files(const std::vector<TrialObject>& objects,
                                                const std::vector<sound::Cue>& sounds) {
  std::vector<record::ObjectFileRow> rows;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const TrialObject& object = objects[i];
    if (!object.file.empty()) {
      rows.push_back({static_cast<std::int32_t>(i), object.name, object.file.string(),
                      object.file_bytes, object.file_checksum});
    }
    if (!object.constants_file.empty()) {
      rows.push_back({static_cast<std::int32_t>(i), object.name + ".calibrated",
                      object.constants_file.string(), object.constants_bytes,
                      object.constants_checksum});
    }
  }
  for (const sound::Cue& sound : sounds) {
    if (!sound.file.empty()) {
      const std::string bytes = file_text(sound.file);
      rows.push_back(
          {-1, "sounds." + sound.name, sound.file.filename().string(), bytes.size(), fnv1a(bytes)});
    }
  }
  return rows;
}

void check_object_files(const record::SessionReader& recorded,
                        const std::vector<record::ObjectFileRow>& now, std::string_view to) {
  for (const record::ObjectFileRow& before : recorded.rows<record::ObjectFileRow>()) {
    const auto same = std::ranges::find(now, before.name, &record::ObjectFileRow::name);
    if (same != now.end() && (same->bytes != before.bytes || same->checksum != before.checksum)) {
      throw InputError(fmt::format(
          "{}: was recorded with another file of {}: '{}' has the checksum {:016x}, the "
          "recording {:016x}; {} it with the same file",
          recorded.path().string(), before.key(), same->file, same->checksum, before.checksum, to));
    }
  }
}

namespace {

/// Why of a solid nothing is proven.
std::string doubt(const scene::RigidObjectParameters& p) {
  return contact::kind_of(p.renderer).passive
             ? "shading turns its force away from its spring"
             : fmt::format("its renderer is \"{}\"", contact::name_of(p.renderer));
}

}  // namespace

std::vector<std::string> words_of_rigid_objects(const std::vector<scene::Field>& fields,
                                                double rate, double damping) {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const auto* p = std::get_if<scene::RigidObjectParameters>(&fields[i].kind);
    if (p == nullptr) {
      continue;
    }
    const scene::StiffnessBound bound = scene::stiffness_bound(fields, i);
    const double needed = 0.5 * bound.stiffness / rate;
    lines.push_back(fmt::format(
        "objects.{}: at most {:.4g} N/m; {} {:.3g} N·s/m of damping at {:g} Hz (K T / 2){}; it "
        "has {:g} itself, and the hand of [hand] has {:g}",
        fields[i].name, bound.stiffness,
        bound.passive ? "passive with more than" : "its spring alone needs", needed, rate,
        bound.passive ? "" : ", and nothing is proven of it, since " + doubt(*p), p->gains.damping,
        damping));
    if (p->body && p->body->facing == geometry::Facing::kInwards) {
      lines.push_back(fmt::format(
          "objects.{}: its faces look inwards, so that it is a room, free inside and solid around; "
          "haptrial mesh repair turns them",
          fields[i].name));
    }
  }
  return lines;
}

}  // namespace haptrial::protocols
