#pragma once

// The shipped kinds of fields. Each has the schemas of its keys, its reader and its entry in the
// file that is named after the file of its law: push_kinds.cpp for core/scene/push.h. Those that
// are felt as a surface stand with their shapes (shape_kinds.cpp).

#include "core/scene/read/field_kinds.h"

namespace haptrial::scene {

KindOfField constant_field();
KindOfField ramp_field();
KindOfField pulse_field();
KindOfField measured_field();
KindOfField spring_field();
KindOfField wall_field();
KindOfField box_field();
KindOfField sphere_field();
KindOfField cylinder_field();
KindOfField channel_field();
KindOfField plane_field();
KindOfField viscous_field();
KindOfField matrix_viscous_field();
KindOfField inertia_field();
KindOfField friction_field();
KindOfField grating_field();
KindOfField texture_field();
KindOfField vibration_field();
KindOfField tap_field();
KindOfField detent_field();
KindOfField click_field();
KindOfField minimum_jerk_field();
KindOfField path_field();
KindOfField curve_field();

inline constexpr double kNoFade = 0.0;  // of what has a course in time of its own [s]

/// Reader of a kind whose keys are those of one schema.
template <class T, const Schema<T>& (*schema)()>
FieldKind read_by(Table& table, const FieldSetting&) {
  return schema().read(table);
}

// Descriptions of keys that kinds in several files have.
inline constexpr const char* kTo =
    "Force of a ramp at its end, place that the hand is pulled to, or end of a channel";
inline constexpr const char* kToAbsent = "needed, but for a channel with axes";
inline constexpr const char* kFrom = "Force of a ramp at its beginning, or beginning of a channel";
inline constexpr const char* kFromAbsent = "no force of a ramp, axes of a channel";
inline constexpr const char* kOn =
    "Name of the surface, a field, that this field belongs to: it rubs, shapes or strikes there";
inline constexpr const char* kDirection = "Direction in which a field acts or is laid out";
inline constexpr const char* kLowest =
    "Lowest frequency of a texture or of a vibration that is noise";
inline constexpr const char* kHighest =
    "Highest frequency of a texture or of a vibration that is noise";
inline constexpr const char* kSeed = "Seed of the random numbers of a texture, noise or path";

}  // namespace haptrial::scene
