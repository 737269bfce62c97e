#include "core/deformable/elements/deform_setup.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cctype>

#include "core/base/definition/table_vector.h"
#include "core/base/error.h"

namespace haptrial::deformable {
namespace {

using Eigen::Vector3d;

BodySource read_source(Table table) {
  BodySource source;
  if (table.has("block") + table.has("tetrahedra") + table.has("mesh") > 1) {
    table.reject("block", "stands beside mesh or tetrahedra; keep one of the three");
    table.leave("mesh");
    table.leave("tetrahedra");
  }
  if (table.has("block")) {
    source.block = read_vector(table, "block", kPositive, "m", Vector3d::Ones());
  } else if (table.has("tetrahedra")) {
    source.tetrahedra = table.text("tetrahedra");
  } else {
    source.mesh = table.text("mesh");
  }
  if (!source.block) {
    source.scale = table.number_or("scale", 1.0, kPositive, "m");
  }
  if (table.has("shift")) {
    source.shift = read_vector(table, "shift", {}, "m");
  }
  if (source.tetrahedra.empty()) {
    source.resolution = table.integer_or("resolution", 20, 1, 1000);
  }
  return source;
}

Material read_material(Table& table) {
  Material material;
  material.young = table.number("young", kPositive, "Pa");
  material.poisson = table.number("poisson", {}, "");
  material.density = table.number_or("density", 1000.0, kPositive, "kg/m³");
  if (!(material.poisson > -1.0 && material.poisson < 0.5)) {
    table.reject("poisson", fmt::format("{}", material.poisson), "above -1 and below 0.5");
  }
  return material;
}

/// A name of a region that the file has.
std::string read_region_name(Table& table, const char* key, const DeformSetup& setup) {
  std::vector<std::string> allowed;
  for (const auto& [name, region] : setup.regions) {
    allowed.push_back(name);
  }
  return table.choice(key, allowed);
}

std::vector<NamedMaterial> read_materials(Table& root, const DeformSetup& setup) {
  Table base = root.table("material");
  std::vector<NamedMaterial> materials{{"material", read_material(base), ""}};
  if (root.has("materials")) {
    Table more = root.table("materials");
    for (const std::string& name : more.keys_as_written()) {
      Table table = more.table(name);
      NamedMaterial& material = materials.emplace_back();
      material.name = name;
      material.material = read_material(table);
      material.region = read_region_name(table, "region", setup);
    }
  }
  return materials;
}

void read_session(Table& table, SetupLoad& load) {
  if (!table.has("session")) {
    return;
  }
  load.session = table.text("session");
  load.object = table.has("object") ? table.text("object") : "";
  load.trial = table.integer_or("trial", 0, 1, 1000000);
  load.touches = table.integer_or("touches", 5, 1, 1000);
}

/// Answers of a load are in files of its name.
bool names_files(const std::string& name) {
  return !name.empty() && std::ranges::all_of(name, [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '-' || c == '_' || c == ' ';
  });
}

SetupLoad read_load(Table table, const std::string& name, const DeformSetup& setup) {
  SetupLoad load;
  load.name = name;
  for (const std::string& held : table.texts("held")) {
    if (setup.regions.contains(held)) {
      load.held.push_back(held);
    } else {
      table.reject("held", fmt::format("'{}'", held), "names of [regions]");
    }
  }
  if (table.has("forces")) {
    for (Table& one : table.tables("forces")) {
      load.forces.push_back(
          {read_region_name(one, "region", setup), read_vector(one, "force", {}, "N")});
    }
  }
  if (table.has("pressures")) {
    for (Table& one : table.tables("pressures")) {
      load.pressures.push_back(
          {read_region_name(one, "region", setup), one.number("pressure", {}, "Pa")});
    }
  }
  if (table.has("moved")) {
    for (Table& one : table.tables("moved")) {
      load.moved.push_back(
          {read_region_name(one, "region", setup), read_vector(one, "by", {}, "m")});
    }
  }
  read_session(table, load);
  load.reference = table.has("reference") ? table.text("reference") : "";
  load.unseen = table.has("unseen") && table.boolean("unseen");
  return load;
}

void read_elements(Table& root, DeformSetup& setup) {
  if (!root.has("elements")) {
    return;
  }
  Table table = root.table("elements");
  if (table.has("law")) {
    std::vector<std::string> names;
    for (const Law law : {Law::kLinear, Law::kCorotational, Law::kNeoHookean}) {
      names.emplace_back(name_of(law));
    }
    const std::string law = table.choice("law", names);
    setup.law = std::find(names.begin(), names.end(), law) == names.end() ? Law::kNeoHookean
                                                                          : law_named(law);
  }
  if (table.has("volume") && table.choice("volume", {"patches", "tetrahedra"}) == "tetrahedra") {
    setup.volume = VolumeForm::kTetrahedra;
  }
  setup.tolerance = table.number_or("tolerance", 1e-8, {1e-12, 1e-2, false}, "");
}

/// Adds what is held and moved; what is moved is not held where it lies.
void add_holds(const SetupLoad& load, const std::map<std::int32_t, Vector3d>& moved,
               const std::vector<std::int32_t>& still, LoadCase& result) {
  std::map<std::int32_t, Vector3d> all;
  for (const std::int32_t v : still) {
    all[v] = Vector3d::Zero();
  }
  for (const auto& [vertex, by] : moved) {
    if (const auto [at, fresh] = all.emplace(vertex, by); !fresh) {
      throw InputError(
          fmt::format("load '{}': vertex {} is in a region that is held and in one that "
                      "is moved",
                      load.name, vertex));
    }
  }
  for (const auto& [vertex, by] : all) {
    result.holds.push_back({vertex, by});
  }
}

}  // namespace

std::filesystem::path DeformSetup::path_of(const std::filesystem::path& name) const {
  return name.is_absolute() ? name : file.parent_path() / name;
}

DeformSetup read_setup(const std::filesystem::path& file) {
  Table root = Table::load(file);
  DeformSetup setup;
  setup.file = file;
  setup.text = root.source();
  setup.source = read_source(root.table("body"));
  if (root.has("regions")) {
    Table regions = root.table("regions");
    for (const std::string& name : regions.keys_as_written()) {
      Table region = regions.table(name);
      setup.regions[name] = read_region(region);
    }
  }
  setup.materials = read_materials(root, setup);
  read_elements(root, setup);
  if (root.has("loads")) {
    Table loads = root.table("loads");
    for (const std::string& name : loads.keys_as_written()) {
      if (!names_files(name)) {
        loads.reject(name, fmt::format("\"{}\"", name), "letters, digits, -, _ and spaces");
      }
      setup.loads.push_back(read_load(loads.table(name), name, setup));
    }
  }
  root.finish();
  return setup;
}

Elasticity elasticity_of(const DeformSetup& setup, const geometry::TetMesh& body) {
  Elasticity elasticity{{}, {}, setup.law, setup.volume};
  for (const NamedMaterial& named : setup.materials) {
    check_material(named.material, fmt::format("material '{}'", named.name));
    elasticity.materials.push_back(named.material);
  }
  if (setup.materials.size() == 1) {
    return elasticity;
  }
  geometry::TetMesh middles;  // a vertex for each tetrahedron
  for (const geometry::Tetrahedron& t : body.tetrahedra) {
    Vector3d sum = Vector3d::Zero();
    for (const std::int32_t v : t) {
      sum += body.vertices[static_cast<std::size_t>(v)];
    }
    middles.vertices.push_back(sum / 4);
  }
  elasticity.material_of.assign(body.tetrahedra.size(), 0);
  for (std::size_t m = 1; m < setup.materials.size(); ++m) {
    const NamedMaterial& named = setup.materials[m];
    const auto inside = vertices_in(setup.regions.at(named.region), middles);
    if (inside.empty()) {
      throw InputError(
          fmt::format("material '{}': no tetrahedron has its middle in the region '{}'", named.name,
                      named.region));
    }
    for (const std::int32_t t : inside) {
      elasticity.material_of[static_cast<std::size_t>(t)] = static_cast<std::uint8_t>(m);
    }
  }
  return elasticity;
}

LoadCase load_case_of(const DeformSetup& setup, const SetupLoad& load,
                      const geometry::TetMesh& body) {
  const auto in = [&](const std::string& region) {
    auto found = vertices_in(setup.regions.at(region), body);
    if (found.empty()) {
      throw InputError(
          fmt::format("load '{}': no vertex of the body is in the region '{}'", load.name, region));
    }
    return found;
  };
  LoadCase result{load.name, {}, {}};
  std::vector<std::int32_t> still;
  for (const std::string& region : load.held) {
    const auto vertices = in(region);
    still.insert(still.end(), vertices.begin(), vertices.end());
  }
  std::map<std::int32_t, Vector3d> moved;
  for (const RegionMove& move : load.moved) {
    for (const std::int32_t v : in(move.region)) {
      moved[v] = move.by;
    }
  }
  add_holds(load, moved, still, result);
  for (const RegionForce& one : load.forces) {
    const auto vertices = in(one.region);
    for (const std::int32_t v : vertices) {
      result.forces.push_back({v, one.force / static_cast<double>(vertices.size())});
    }
  }
  const auto surface =
      load.pressures.empty() ? std::vector<Face>() : mesh_parts(body.tetrahedra).surface;
  for (const RegionPressure& one : load.pressures) {
    const auto faces = faces_in(setup.regions.at(one.region), body, surface);
    if (faces.empty()) {
      throw InputError(fmt::format("load '{}': no outer face of the body is in the region '{}'",
                                   load.name, one.region));
    }
    for (const Face& face : faces) {
      const auto at = [&](std::size_t i) -> const Vector3d& {
        return body.vertices[static_cast<std::size_t>(face[i])];
      };
      const Vector3d area = 0.5 * (at(1) - at(0)).cross(at(2) - at(0));
      for (const std::int32_t v : face) {
        result.forces.push_back({v, -one.pressure / 3 * area});
      }
    }
  }
  return result;
}

}  // namespace haptrial::deformable
