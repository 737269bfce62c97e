#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

// The arrows between modules stand once, in the haptrial_module lines of CMakeLists.txt. These
// tests hold every #include against them, and the arrows against the layers of the design.
namespace haptrial::includes_test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;
namespace fs = std::filesystem;

const fs::path kRoot = HAPTRIAL_SOURCE_DIR;

std::string contents(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

struct Module {
  std::string folder;
  std::set<std::string> links;  // modules that it names
};
using Modules = std::map<std::string, Module>;

Modules parse_modules(const std::string& cmake) {
  Modules modules;
  const std::string text = std::regex_replace(cmake, std::regex("#[^\n]*"), "");
  const std::regex line(R"(haptrial_(?:module|group)\(([^)]*)\))");  // a group has no source
  for (std::sregex_iterator it(text.begin(), text.end(), line), end; it != end; ++it) {
    std::istringstream words((*it)[1].str());
    std::string name;
    Module module;
    words >> name >> module.folder;
    bool links = false;
    for (std::string word; words >> word;) {
      if (word == "LINKS" || word == "USES") {
        links = word == "LINKS";
      } else if (links && word.find("::") == std::string::npos) {
        module.links.insert(word);
      }
    }
    modules[name] = module;
  }
  return modules;
}

/// The module and all that it reaches along the arrows.
std::set<std::string> reach(const Modules& modules, const std::string& name) {
  std::set<std::string> reached{name};
  std::vector<std::string> open{name};
  while (!open.empty()) {
    const std::string next = open.back();
    open.pop_back();
    for (const std::string& link : modules.at(next).links) {
      if (reached.insert(link).second) {
        open.push_back(link);
      }
    }
  }
  return reached;
}

/// "core" for core/base, "protocols" for protocols.
std::string layer(const std::string& folder) { return folder.substr(0, folder.find('/')); }

bool layers_allow(const std::string& from, const std::string& to) {
  static const std::map<std::string, std::set<std::string>> allowed{
      {"core", {"core"}},
      {"protocols", {"core", "protocols"}},
      {"analysis", {"core", "analysis"}},
      {"experiments", {"core", "protocols", "analysis", "experiments"}}};
  return allowed.contains(from) && allowed.at(from).contains(to);
}

std::vector<std::string> includes(const std::string& text) {
  static const std::regex line("(?:^|\n)[ \t]*#[ \t]*include[ \t]*[<\"]([^>\"\n]+)[>\"]");
  std::vector<std::string> found;
  for (std::sregex_iterator it(text.begin(), text.end(), line), end; it != end; ++it) {
    found.push_back((*it)[1]);
  }
  return found;
}

/// The project's includes in the text of a file of module `name` that the arrows do not allow.
std::vector<std::string> backward_includes(const Modules& modules, const std::string& name,
                                           const std::string& text) {
  static const std::set<std::string> ours{"core", "protocols", "analysis", "experiments", "tests"};
  std::map<std::string, std::string> module_of;  // by folder
  for (const auto& [module, what] : modules) {
    module_of[what.folder] = module;
  }
  const auto reached = reach(modules, name);
  std::vector<std::string> bad;
  for (const std::string& include : includes(text)) {
    const std::string folder = fs::path(include).parent_path().string();
    const bool of_project = ours.contains(layer(include)) || layer(include) == "..";
    if (!of_project) {
      continue;
    }
    const auto target = module_of.find(folder);
    if (target == module_of.end() || !reached.contains(target->second) ||
        !layers_allow(layer(modules.at(name).folder), layer(folder))) {
      bad.push_back(include);
    }
  }
  return bad;
}

std::vector<fs::path> sources(const fs::path& folder, bool below) {
  std::vector<fs::path> files;
  const auto take = [&](const fs::directory_entry& entry) {
    const auto kind = entry.path().extension();
    if (entry.is_regular_file() && (kind == ".h" || kind == ".cpp")) {
      files.push_back(entry.path());
    }
  };
  if (below) {
    std::ranges::for_each(fs::recursive_directory_iterator(folder), take);
  } else {
    std::ranges::for_each(fs::directory_iterator(folder), take);
  }
  return files;
}

/// "core/geometry/bvh/bvh" of bvh.h and bvh.cpp in core/geometry/bvh.
std::string pair_of(fs::path file) { return file.replace_extension().generic_string(); }

/// "bvh" and "bvh_internal" are one idea.
std::string idea_of(const std::string& pair) {
  constexpr std::string_view kInternal = "_internal";
  return pair.ends_with(kInternal) ? pair.substr(0, pair.size() - kInternal.size()) : pair;
}

/// Each file pair with those that it includes, but for an internal header of its own.
using Pairs = std::map<std::string, std::set<std::string>>;

Pairs pairs_below(const fs::path& root, const std::string& folder) {
  Pairs pairs;
  for (const fs::path& file : sources(root / folder, true)) {
    const std::string pair = pair_of(fs::relative(file, root));
    auto& reached = pairs[pair];
    for (const std::string& include : includes(contents(file))) {
      const std::string other = pair_of(include);
      if (fs::exists(root / include) && idea_of(other) != idea_of(pair)) {
        reached.insert(other);
      }
    }
  }
  return pairs;
}

/// The pairs from which includes lead back to themselves.
std::vector<std::string> in_circles(Pairs pairs) {
  // A pair is in no circle if it includes none that is left, or none that is left includes it.
  bool changed = true;
  while (changed) {
    std::set<std::string> included;
    for (auto& [pair, includes] : pairs) {
      std::erase_if(includes, [&](const std::string& other) { return !pairs.contains(other); });
      included.insert(includes.begin(), includes.end());
    }
    changed = std::erase_if(pairs, [&](const auto& each) {
                return each.second.empty() || !included.contains(each.first);
              }) > 0;
  }
  std::vector<std::string> left;
  for (const auto& [pair, includes] : pairs) {
    left.push_back(pair);
  }
  return left;
}

const Modules& modules_of_project() {
  static const Modules modules = parse_modules(contents(kRoot / "CMakeLists.txt"));
  return modules;
}

const Modules kExample = parse_modules(
    "haptrial_module(base core/base LINKS Eigen3::Eigen USES PkgConfig::gsl)\n"
    "haptrial_module(control core/control LINKS base)\n"
    "haptrial_module(device core/device LINKS base)  # haptrial_module(no such/one)\n"
    "haptrial_module(protocols protocols LINKS control\n    device)\n"
    "haptrial_module(analysis analysis LINKS base)\n"
    "haptrial_module(experiments experiments LINKS protocols analysis)\n");

TEST(IncludesTest, ModulesAreReadFromTheirLines) {
  EXPECT_THAT(kExample, SizeIs(6));
  EXPECT_EQ(kExample.at("protocols").folder, "protocols");
  EXPECT_THAT(kExample.at("protocols").links, ElementsAre("control", "device"));
  EXPECT_THAT(reach(kExample, "protocols"), ElementsAre("base", "control", "device", "protocols"));
}

TEST(IncludesTest, ABackwardIncludeIsFound) {
  const auto bad = [](const std::string& module, const std::string& text) {
    return backward_includes(kExample, module, text);
  };
  EXPECT_THAT(bad("base", "#include \"protocols/interface/pass.h\"\n"),
              ElementsAre("protocols/interface/pass.h"));
  EXPECT_THAT(bad("analysis", "#pragma once\n#include \"protocols/interface/pass.h\"\n"),
              SizeIs(1));
  EXPECT_THAT(bad("protocols", "#include \"analysis/force_training/score/score.h\"\n"), SizeIs(1));
  EXPECT_THAT(bad("protocols", "#include \"experiments/runner/session.h\"\n"), SizeIs(1));
  EXPECT_THAT(bad("control", "#include \"core/device/device.h\"\n"), SizeIs(1)) << "not linked";
  EXPECT_THAT(bad("base", "  #  include <core/control/pd_controller.h>\n"), SizeIs(1));
  EXPECT_THAT(bad("base", "#include \"tests/support/free_mass.h\"\n"), SizeIs(1));
  EXPECT_THAT(bad("control", "#include \"../device/device.h\"\n"), SizeIs(1));
  EXPECT_THAT(bad("base", "#include \"core/nowhere/x.h\"\n"), SizeIs(1));
}

TEST(IncludesTest, AnAllowedIncludeIsNot) {
  const std::string text =
      "#include \"core/control/pd_controller.h\"\n#include <vector>\n#include <Eigen/Core>\n"
      "// #include \"analysis/force_training/score/score.h\"\n#include \"core/base/error.h\"\n";
  EXPECT_THAT(backward_includes(kExample, "protocols", text), IsEmpty());
  EXPECT_THAT(backward_includes(kExample, "experiments", text), IsEmpty());
}

TEST(IncludesTest, AnArrowAgainstTheLayersIsNoExcuse) {
  const Modules wrong = parse_modules(
      "haptrial_module(base core/base LINKS protocols)\nhaptrial_module(protocols protocols)\n");
  EXPECT_THAT(backward_includes(wrong, "base", "#include \"protocols/interface/pass.h\"\n"),
              SizeIs(1));
}

TEST(IncludesTest, PairsInCirclesAreFound) {
  EXPECT_THAT(in_circles({{"a", {"b"}}, {"b", {"c", "other"}}, {"c", {}}}), IsEmpty());
  EXPECT_THAT(in_circles({{"a", {"b"}}, {"b", {"c"}}, {"c", {"b"}}, {"d", {"a"}}}),
              ElementsAre("b", "c"));
  EXPECT_THAT(in_circles({{"a", {"b"}}, {"b", {"c"}}, {"c", {"a"}}}), SizeIs(3));
}

TEST(ArchitectureTest, NoFileIncludesAgainstTheArrows) {
  std::size_t files = 0;
  std::size_t of_project = 0;
  for (const auto& [name, module] : modules_of_project()) {
    for (const fs::path& file : sources(kRoot / module.folder, false)) {
      const std::string text = contents(file);
      ++files;
      for (const std::string& include : includes(text)) {
        of_project += layer(include) == "core";
      }
      EXPECT_THAT(backward_includes(modules_of_project(), name, text), IsEmpty())
          << file << " may include: itself and what " << name << " links";
    }
  }
  EXPECT_GT(files, 50u) << "the test looked at the project";
  EXPECT_GT(of_project, files / 2);
}

TEST(ArchitectureTest, TheArrowsFollowTheLayersAndMakeNoCircle) {
  const Modules& modules = modules_of_project();
  ASSERT_GE(modules.size(), 10u);
  for (const auto& [name, module] : modules) {
    for (const std::string& link : module.links) {
      ASSERT_TRUE(modules.contains(link)) << name << " links " << link;
      EXPECT_TRUE(layers_allow(layer(module.folder), layer(modules.at(link).folder)))
          << name << " -> " << link;
      EXPECT_FALSE(reach(modules, link).contains(name)) << name << " -> " << link << " -> " << name;
    }
  }
}

TEST(ArchitectureTest, EverySourceBelongsToAModule) {
  std::set<fs::path> folders;
  for (const auto& [name, module] : modules_of_project()) {
    folders.insert(kRoot / module.folder);
  }
  for (const char* layer_name : {"core", "protocols", "analysis", "experiments"}) {
    for (const fs::path& file : sources(kRoot / layer_name, true)) {
      const bool is_main = file == kRoot / "experiments/main.cpp";
      EXPECT_TRUE(is_main || folders.contains(file.parent_path())) << file << " is never compiled";
    }
  }
}

constexpr std::array kLayers{"core", "protocols", "analysis", "experiments"};

TEST(ArchitectureTest, NoFilePairIncludesItselfByWayOfOthers) {
  for (const char* layer : kLayers) {
    const Pairs pairs = pairs_below(kRoot, layer);
    EXPECT_GT(pairs.size(), 20u) << layer;
    EXPECT_THAT(in_circles(pairs), IsEmpty());
  }
}

TEST(ArchitectureTest, HeavyLibrariesStayOutOfHeaders) {
  const std::regex heavy(
      "(toml\\+\\+/|toml\\.hpp|nlohmann/|gsl/|hdf5|H5|GL/|GLFW/|X11/|ft2build|freetype/|pango/"
      "|fontconfig/|CLI/"
      "|sundials/|cvode/|boost/|fmt/).*");
  for (const auto& [name, module] : modules_of_project()) {
    for (const fs::path& file : sources(kRoot / module.folder, false)) {
      if (file.extension() != ".h") {
        continue;
      }
      // An internal header belongs to the few sources that wrap one library.
      const bool internal = file.stem().string().ends_with("_internal");
      for (const std::string& include : includes(contents(file))) {
        EXPECT_TRUE(internal || !std::regex_match(include, heavy))
            << file << " includes " << include;
      }
      EXPECT_EQ(contents(file).rfind("#pragma once\n", 0), 0u) << file;
    }
  }
}

}  // namespace
}  // namespace haptrial::includes_test
