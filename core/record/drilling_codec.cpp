#include "core/record/drilling_codec.h"

#include "core/record/packed_row.h"
#include "core/record/rounding.h"

namespace haptrial::record {
namespace {

/// Fields go out as their columns are: `f32` of a double on its grid, the rest as they are.
class Put {
 public:
  explicit Put(std::size_t bytes) : row_(bytes) {}
  void plain(std::uint64_t value) { row_.put(value); }
  void plain(std::int64_t value) { row_.put(value); }
  void plain(std::int32_t value) { row_.put(value); }
  void plain(std::uint32_t value) { row_.put(value); }
  void plain(std::uint8_t value) { row_.put(value); }
  void plain(bool value) { row_.put(static_cast<std::uint8_t>(value ? 1 : 0)); }
  void plain(double value) { row_.put(value); }
  void plain(float value) { row_.put(value); }
  void f32(double value, double resolution = 0.0) {
    row_.put(static_cast<float>(resolution > 0.0 ? on_grid(value, resolution) : value));
  }
  void text(const std::string& value, std::size_t bytes, const char* what) {
    row_.put_text(value, bytes, what);
  }
  PackedRow& row() { return row_; }

 private:
  PackedRow row_;
};

class Get {
 public:
  Get(const BytePlanes& planes, std::size_t at) : row_(planes, at) {}
  template <class T>
  void plain(T& value) {
    value = row_.get<T>();
  }
  void plain(bool& value) { value = row_.get<std::uint8_t>() != 0; }
  void f32(double& value, double /*resolution*/ = 0.0) {
    value = static_cast<double>(row_.get<float>());
  }
  void text(std::string& value, std::size_t bytes, const char*) { value = row_.get_text(bytes); }

 private:
  PackedRow row_;
};

// Each visits the fields of a row in column order; Row is const where they are put.

template <class V, class Voxel>
void visit_voxel(V& v, Voxel& voxel) {
  for (auto& index : voxel) v.plain(index);
}

template <class V, class Vector>
void visit_vector(V& v, Vector& vector) {
  for (Eigen::Index a = 0; a < 3; ++a) v.plain(vector[a]);
}

template <class V>
void visit(V& v, auto& r, const ToolRow*) {
  v.plain(r.sequence);
  v.f32(r.orientation.w(), kOrientationResolution);
  v.f32(r.orientation.x(), kOrientationResolution);
  v.f32(r.orientation.y(), kOrientationResolution);
  v.f32(r.orientation.z(), kOrientationResolution);
  v.plain(r.buttons);
  v.plain(r.keys);
  v.f32(r.pedal, kPedalResolution);
  v.plain(r.tool);
  v.plain(r.mode);
  v.plain(r.active);
  v.plain(r.power);
  v.plain(r.piece);
  v.plain(r.immersed);
  v.f32(r.removed);
  for (Eigen::Index a = 0; a < 3; ++a) v.f32(r.contact[a], kForceResolution);
}

template <class V>
void visit(V& v, auto& r, const RemovalRow*) {
  v.plain(r.sequence);
  v.plain(r.piece);
  visit_voxel(v, r.voxel);
  v.plain(r.label);
  v.f32(r.force);
  v.f32(r.speed);
}

template <class V>
void visit(V& v, auto& r, const CameraRow*) {
  v.plain(r.sequence);
  v.plain(r.time_ns);
  visit_vector(v, r.eye);
  visit_vector(v, r.target);
  visit_vector(v, r.up);
  v.plain(r.field_of_view);
}

template <class V>
void visit(V& v, auto& r, const SplitRow*) {
  v.plain(r.sequence);
  v.plain(r.from);
  v.plain(r.to);
  visit_voxel(v, r.voxel);
}

template <class V>
void visit(V& v, auto& r, const BoneRow*) {
  v.plain(r.bone);
  v.text(r.name, kNameBytes, "bone");
  v.text(r.source, kTextBytes, "source of a bone");
  visit_voxel(v, r.size);
  visit_vector(v, r.origin);
  v.plain(r.spacing);
}

template <class V>
void visit(V& v, auto& r, const StructureRow*) {
  v.plain(r.bone);
  v.plain(r.label);
  v.text(r.name, kNameBytes, "structure");
  for (auto& share : r.colour) v.f32(share);
  v.plain(r.hardness);
  v.plain(r.vital);
}

template <class V>
void visit(V& v, auto& r, const BoneRunRow*) {
  v.plain(r.bone);
  v.plain(r.first);
  v.plain(r.count);
  v.plain(r.label);
}

template <class V>
void visit(V& v, auto& r, const BoneDensityRow*) {
  v.plain(r.bone);
  v.plain(r.voxel);
  v.plain(r.density);
}

template <class V>
void visit(V& v, auto& r, const ProcedureRow*) {
  v.plain(r.pass);
  v.plain(r.bone);
  v.plain(r.pieces);
  v.plain(r.emptied);
  v.plain(r.before);
  v.plain(r.left);
  v.plain(r.cut);
  v.plain(r.dust);
  v.plain(r.suctioned);
  v.plain(r.fallen);
  v.plain(r.checksum);
}

}  // namespace

template <class Row>
void put_row(BytePlanes& planes, std::size_t at, const Row& row) {
  Put put(planes.row_bytes());
  visit(put, row, static_cast<const Row*>(nullptr));
  planes.put_row(at, put.row().bytes());
}

template <class Row>
Row get_row(const BytePlanes& planes, std::size_t at) {
  Get get(planes, at);
  Row row;
  visit(get, row, static_cast<const Row*>(nullptr));
  return row;
}

#define HAPTRIAL_DRILLING_ROW(Row, table)                           \
  template <>                                                       \
  DrillingTable table_of<Row>() {                                   \
    return DrillingTable::table;                                    \
  }                                                                 \
  template void put_row<Row>(BytePlanes&, std::size_t, const Row&); \
  template Row get_row<Row>(const BytePlanes&, std::size_t);

HAPTRIAL_DRILLING_ROW(ToolRow, kTool)
HAPTRIAL_DRILLING_ROW(RemovalRow, kRemovals)
HAPTRIAL_DRILLING_ROW(CameraRow, kCamera)
HAPTRIAL_DRILLING_ROW(SplitRow, kSplits)
HAPTRIAL_DRILLING_ROW(BoneRow, kBones)
HAPTRIAL_DRILLING_ROW(StructureRow, kStructures)
HAPTRIAL_DRILLING_ROW(BoneRunRow, kBoneRuns)
HAPTRIAL_DRILLING_ROW(BoneDensityRow, kBoneDensities)
HAPTRIAL_DRILLING_ROW(ProcedureRow, kProcedures)
#undef HAPTRIAL_DRILLING_ROW

}  // namespace haptrial::record
