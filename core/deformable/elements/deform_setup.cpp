#include "core/deformable/elements/deform_setup.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cctype>

#include "core/base/definition/schema.h"
#include "core/base/error.h"

namespace haptrial::deformable {
namespace {

using Eigen::Vector3d;

const Schema<BodySource>& source_schema() {
  using B = BodySource;
  static const auto schema =
      Schema<B>()
          .check([](Table& table, B&) {
            if (table.has("block") + table.has("tetrahedra") + table.has("mesh") > 1) {
              table.reject("block", "stands beside mesh or tetrahedra; keep one of the three");
              table.leave("mesh");
              table.leave("tetrahedra");
            }
          })
          .custom("block", "Sides of a block, in place of a file",
                  [](Table& table, const std::string& key, B& source) {
                    source.block = read_vector(table, key, kPositive, "m", Vector3d::Ones());
                  })
          .check([](Table& table, B& source) {
            table.describe({"tetrahedra", "File of the body's tetrahedra: TetGen's .node with .ele",
                            "block or mesh", false});
            table.describe({"mesh", "File of the body's surface, which is filled with tetrahedra",
                            "block or tetrahedra", false});
            if (!source.block && table.has("tetrahedra")) {
              source.tetrahedra = table.text("tetrahedra");
            } else if (!source.block) {
              source.mesh = table.text("mesh");
            }
          })
          .number("scale", &B::scale, kPositive, "m", "Length of the file's unit")
          .only_if([](const B& source) { return !source.block; })
          .vector("shift", &B::shift, {}, "m", "Displacement that is added to every vertex")
          .integer("resolution", &B::resolution, 1, 1000, "Cubes along the body's longest side")
          .only_if([](const B& source) { return source.tetrahedra.empty(); });
  return schema;
}

const Schema<Material>& material_schema() {
  using M = Material;
  static const auto schema =
      Schema<M>()
          .number("young", &M::young, kPositive, "Pa", "Young's modulus of the material")
          .required()
          .number("poisson", &M::poisson, {}, "", "Poisson's ratio of the material")
          .required()
          .number("density", &M::density, kPositive, "kg/m³", "Density of the material")
          .check([](Table& table, M& material) {
            if (!(material.poisson > -1.0 && material.poisson < 0.5)) {
              table.reject("poisson", fmt::format("{}", material.poisson),
                           "above -1 and below 0.5");
            }
          });
  return schema;
}

/// Reader of a key that names a region of the file.
template <class T>
auto region_reader(std::string T::*member, const DeformSetup& setup) {
  return [member, &setup](Table& table, const std::string& key, T& into) {
    std::vector<std::string> allowed;
    for (const auto& [name, region] : setup.regions) {
      allowed.push_back(name);
    }
    into.*member = table.choice(key, allowed);
  };
}

std::vector<NamedMaterial> read_materials(Table& root, const DeformSetup& setup) {
  Table base = root.table("material");
  std::vector<NamedMaterial> materials{{"material", material_schema().read(base), ""}};
  if (root.has("materials")) {
    const auto schema = Schema<NamedMaterial>()
                            .keys_of(&NamedMaterial::material, material_schema())
                            .custom("region", "Region whose tetrahedra have the material",
                                    region_reader(&NamedMaterial::region, setup))
                            .required();
    Table more = root.table("materials");
    for (const std::string& name : more.keys_as_written()) {
      Table table = more.table(name);
      materials.push_back(schema.read(table));
      materials.back().name = name;
    }
  }
  return materials;
}

/// Answers of a load are in files of its name.
bool names_files(const std::string& name) {
  return !name.empty() && std::ranges::all_of(name, [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '-' || c == '_' || c == ' ';
  });
}

/// The keys of a load that are recorded contacts.
const Schema<SetupLoad>& session_schema() {
  using L = SetupLoad;
  static const auto schema =
      Schema<L>()
          .text("session", &L::session, "Session file whose recorded contacts act beside the rest")
          .text("object", &L::object, "Object of the session whose contacts act")
          .otherwise("the one that was touched")
          .integer("trial", &L::trial, 1, 1000000, "Trial of the session whose contacts act")
          .otherwise("the first in which the object was touched")
          .integer("touches", &L::touches, 1, 1000,
                   "Moments of the session, each of which is a load of its own");
  return schema;
}

/// Reader of a list of tables, whose keys `schema` describes.
template <class Row>
auto rows_reader(std::vector<Row> SetupLoad::*rows, const Schema<Row>& schema) {
  return [rows, schema](Table& table, const std::string& key, SetupLoad& load) {
    for (Table& one : table.tables(key)) {
      (load.*rows).push_back(schema.read(one));
    }
  };
}

Schema<SetupLoad> make_load_schema(const DeformSetup& setup) {
  using L = SetupLoad;
  const auto force = Schema<RegionForce>()
                         .custom("region", "Region on which the force acts",
                                 region_reader(&RegionForce::region, setup))
                         .required()
                         .vector("force", &RegionForce::force, {}, "N",
                                 "Force on the region in sum, equal on its vertices")
                         .required();
  const auto pressure = Schema<RegionPressure>()
                            .custom("region", "Region on which the pressure acts",
                                    region_reader(&RegionPressure::region, setup))
                            .required()
                            .number("pressure", &RegionPressure::pressure, {}, "Pa",
                                    "Pressure against the outer faces of the region, at rest")
                            .required();
  const auto move =
      Schema<RegionMove>()
          .custom("region", "Region that is moved", region_reader(&RegionMove::region, setup))
          .required()
          .vector("by", &RegionMove::by, {}, "m", "Displacement of the region")
          .required();
  return Schema<L>()
      .custom("held", "Regions that do not move",
              [&setup](Table& table, const std::string& key, L& load) {
                for (const std::string& held : table.texts(key)) {
                  if (setup.regions.contains(held)) {
                    load.held.push_back(held);
                  } else {
                    table.reject(key, fmt::format("'{}'", held), "names of [regions]");
                  }
                }
              })
      .required()
      .custom("forces", "Forces on regions", rows_reader(&L::forces, force))
      .custom("pressures", "Pressures on regions", rows_reader(&L::pressures, pressure))
      .custom("moved", "Regions that are moved", rows_reader(&L::moved, move))
      .check([](Table& table, L& load) {
        if (table.has("session")) {
          session_schema().read(table, load);
        }
      })
      .text("reference", &L::reference, "File of displacements by another program (.csv)")
      .flag("unseen", &L::unseen, "Whether a calibration never sees the load and is judged by it");
}

std::vector<std::pair<std::string, Law>> law_words() {
  std::vector<std::pair<std::string, Law>> words;
  for (const Law law : {Law::kLinear, Law::kCorotational, Law::kNeoHookean}) {
    words.emplace_back(name_of(law), law);
  }
  return words;
}

const Schema<DeformSetup>& elements_schema() {
  using D = DeformSetup;
  static const auto schema =
      Schema<D>()
          .choice("law", &D::law, law_words(), "Law of the material")
          .choice("volume", &D::volume,
                  {{"patches", VolumeForm::kPatches}, {"tetrahedra", VolumeForm::kTetrahedra}},
                  "Parts of the body whose changes of volume are resisted")
          .number("tolerance", &D::tolerance, {1e-12, 1e-2}, "",
                  "Unbalanced forces at which the statics end, as a share of loads and reactions");
  return schema;
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
  Table body = root.table("body");
  setup.source = source_schema().read(body);
  if (root.has("regions")) {
    Table regions = root.table("regions");
    for (const std::string& name : regions.keys_as_written()) {
      Table region = regions.table(name);
      setup.regions[name] = read_region(region);
    }
  }
  setup.materials = read_materials(root, setup);
  if (root.has("elements")) {
    Table elements = root.table("elements");
    elements_schema().read(elements, setup);
  }
  if (root.has("loads")) {
    const Schema<SetupLoad> schema = make_load_schema(setup);
    Table loads = root.table("loads");
    for (const std::string& name : loads.keys_as_written()) {
      if (!names_files(name)) {
        loads.reject(name, fmt::format("\"{}\"", name), "letters, digits, -, _ and spaces");
      }
      Table load = loads.table(name);
      setup.loads.push_back(schema.read(load));
      setup.loads.back().name = name;
    }
  }
  root.finish();
  return setup;
}

Elasticity elasticity_of(const DeformSetup& setup, const geometry::TetMesh& body) {
  constexpr std::size_t kMost = 256;  // different numbers in material_of
  if (setup.materials.size() > kMost) {
    throw InputError(fmt::format("{}: the body has {} materials; allowed: at most {}",
                                 setup.file.string(), setup.materials.size(), kMost));
  }
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
      if (const auto [at, fresh] = moved.emplace(v, move.by); !fresh && at->second != move.by) {
        throw InputError(fmt::format(
            "load '{}': vertex {} is in two regions that are moved differently", load.name, v));
      }
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
