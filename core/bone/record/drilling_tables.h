#pragma once

#include <span>
#include <vector>

#include "core/bone/record/drilling_types.h"
#include "core/record/rows/rows.h"
#include "core/record/table/table.h"

namespace haptrial::record {

class SessionReader;

/// The tables of drillings, in the order in which they are created.
const TableList& drilling_tables();

/// The rows that bones have from the beginning; they point into `bones`.
std::vector<Rows> rows_of(std::span<const BoneRecord> bones);

/// Whether the file has these tables.
bool drills(const SessionReader& file);
/// The bones of the session, in their order.
std::vector<BoneRecord> recorded_bones(const SessionReader& file);

template <>
const Table<ToolRow>& table_of<ToolRow>();
template <>
const Table<RemovalRow>& table_of<RemovalRow>();
template <>
const Table<CameraRow>& table_of<CameraRow>();
template <>
const Table<SplitRow>& table_of<SplitRow>();
template <>
const Table<BoneRow>& table_of<BoneRow>();
template <>
const Table<StructureRow>& table_of<StructureRow>();
template <>
const Table<BoneRunRow>& table_of<BoneRunRow>();
template <>
const Table<BoneDensityRow>& table_of<BoneDensityRow>();
template <>
const Table<ProcedureRow>& table_of<ProcedureRow>();

}  // namespace haptrial::record
