#include "protocols/bone_drilling/definition/bone_tables_internal.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/base/definition/schema.h"
#include "protocols/bone_drilling/definition/bone_definition.h"

namespace haptrial::protocols {

namespace {

using D = BoneDefinition;

const Schema<render::TrialDisplayStyle>& picture_schema() {
  using S = render::TrialDisplayStyle;
  static const auto schema =
      Schema<S>()
          .integer("width", &S::width, 160, 8192, "Width of pictures and of a window")
          .required()
          .integer("height", &S::height, 120, 8192, "Height of pictures and of a window")
          .required();
  return schema;
}

const Schema<subject::SkillSpread>& skill_schema() {
  using S = subject::SkillSpread;
  static const auto schema =
      Schema<S>()
          .number("between", &S::between, {0.0, 1.0}, "",
                  "Standard deviation of skill between surgeons of a group")
          .number("within", &S::within, {0.0, 1.0}, "",
                  "Standard deviation of a surgeon's skill from procedure to procedure")
          .number("learning", &S::learning, kFraction, "",
                  "Share of the lack of skill that a surgeon loses with each procedure");
  return schema;
}

const Schema<BoneBeginning>& beginning_schema() {
  using B = BoneBeginning;
  static const auto schema =
      Schema<B>()
          .integer("procedure", &B::procedure, 1, 1000,
                   "Procedure of a recorded session whose bone is drilled on")
          .number("at", &B::at, {0.0, 36000.0}, "s",
                  "Time of the recorded procedure at which its bone is taken")
          .otherwise("its end")
          .text("at_phase", &B::at_phase,
                "Phase at whose beginning the bone is taken, in place of a time: one that the "
                "session of a virtual surgeon tells (/work)")
          .otherwise("none")
          .number("planned_to", &B::planned_to, kFraction, "",
                  "Share of the cavity's depth that is removed by the plan before a procedure "
                  "begins");
  return schema;
}

/// Refuses a beginning that nothing follows.
void check_beginning(Table& table, D& d) {
  const bool recorded = std::any_of(d.sources.begin(), d.sources.end(), is_session);
  for (const char* key : {"procedure", "at", "at_phase"}) {
    if (table.has(key) && !recorded) {
      table.reject(key, "is about a recorded session; name one (.h5) among the bones");
    }
  }
  if (d.beginning.at && !d.beginning.at_phase.empty()) {
    table.reject("at_phase", "stands beside a time; keep at or at_phase");
  }
}

}  // namespace

bool is_session(std::string_view source) { return source.ends_with(".h5"); }

const Schema<Design>& procedures_schema() {
  static const auto schema =
      Schema<Design>()
          .integer("participants", &Design::participants, 1, 10000,
                   "Number of participants of the study")
          .required()
          .integer("procedures", &Design::trials, 1, 1000,
                   "Number of procedures of each session, each on a new bone; [design.session.N] "
                   "may give session N another number")
          .required()
          .integer("sessions", &Design::sessions, 1, 100,
                   "Sessions of each participant, on days of their own")
          .integer("break_after", &Design::break_after, 0, 999,
                   "Number of procedures after which a break comes; 0: no breaks")
          .number("break_duration", &Design::break_duration, {0.0, 86400.0}, "s",
                  "Duration of a break");
  return schema;
}

const Schema<DrillingParameters>& drilling_schema() {
  using P = DrillingParameters;
  static const auto schema =
      Schema<P>()
          .number("force_limit", &P::force_limit, {0.0, 100.0, true}, "N",
                  "Greatest force that the device is given while drilling")
          .required()
          .number("time_limit", &P::time_limit, {0.1, 36000.0}, "s",
                  "Longest duration of a procedure")
          .required()
          .vector("handle", &P::handle, {-1.0, 1.0}, "", "Direction from the tip along the handle")
          .required()
          .check([](Table& table, P& p) {
            if (!(p.handle.norm() > 0.0)) {
              table.reject("handle", "is zero; write the direction from the tip along the handle");
              p.handle = Eigen::Vector3d::UnitY();
            }
          })
          .number("scale", &P::scale, {0.1, 20.0}, "",
                  "Size of the device's workspace over that of the scene; more than 1 scales "
                  "motions down");
  return schema;
}

const Schema<D>& bone_schema() {
  static const auto schema =
      Schema<D>()
          .texts("bones", &D::sources,
                 "Bones to drill: procedural temporal, also as a variant (procedural temporal, low "
                 "tegmen), procedural mandible, files, or recorded sessions (.h5), whose bone is "
                 "drilled on; procedures use them in turn")
          .required()
          .check([](Table& table, D& d) {
            if (d.sources.empty()) {
              table.reject("bones", "is empty; name \"procedural temporal\" or a file");
            }
          })
          .integer("seed", &D::bone_seed, 0, 1'000'000'000,
                   "Seed of procedural bones; another one gives another bone")
          .number("spacing", &D::spacing, {5e-5, 5e-3}, "m",
                  "Edge of a voxel; smaller voxels show more and cost memory and time")
          .otherwise("of the bone")
          .keys_of(&D::placement, placement_schema())
          .flag("mirror", &D::mirror, "Whether left and right of the bones are exchanged")
          .keys_of(&D::beginning, beginning_schema())
          .check(check_beginning);
  return schema;
}

const Schema<D>& beside_schema() {
  static const auto schema =
      Schema<D>()
          .vector("beside", &D::beside, {-0.05, 0.05}, "m",
                  "Offset from the burr's tip at which a virtual participant holds the tube")
          .otherwise("[0.003, 0.003, 0.0]");
  return schema;
}

const Schema<D>& recovery_schema() {
  static const auto schema = Schema<D>().number("recovery", &D::recovery, {0.0, 600.0}, "s",
                                                "Time without force after an aborted pass");
  return schema;
}

const Schema<D>& bone_practice_schema() {
  static const auto schema = Schema<D>()
                                 .number("duration", &D::practice, {0.0, 36000.0}, "s",
                                         "Duration of practice before the first procedure")
                                 .required();
  return schema;
}

constexpr std::size_t kLongestLine = 200;  // over a picture

const Schema<SliceWindow>& slice_window_schema() {
  static const auto schema =
      Schema<SliceWindow>()
          .number("slice_low", &SliceWindow::low, {-10.0, 10.0}, "",
                  "Density that slices show black, and below")
          .number("slice_high", &SliceWindow::high, {-10.0, 10.0}, "",
                  "Density that slices show white, and above")
          .check([](Table& table, SliceWindow& w) {
            if (!(w.high > w.low)) {
              table.reject("slice_high", "is not above slice_low; exchange them");
            }
          });
  return schema;
}

const Schema<D>& bone_display_schema() {
  using render::Quality;
  static const auto schema =
      Schema<D>()
          .keys_of<render::TrialDisplayStyle>(&D::display, picture_schema())
          .flag("stereo", &D::stereo,
                "Whether pictures for the left and the right eye stand side by side")
          .flag("surroundings", &D::surroundings,
                "Whether retracted soft tissue and drapes are drawn around the field; they are "
                "seen, not felt")
          .shown_text("opened_text", &D::opened_text, kLongestLine,
                      "Words over the picture after a vital structure was opened; {structure} and "
                      "{time} stand for its name and when that was")
          .placeholders({"{structure}", "{time}"})
          .shown_text("time_text", &D::time_text, kLongestLine,
                      "Words in a corner of the picture for the time that is left, {time}")
          .placeholders({"{time}"})
          .shown_text("plan_text", &D::plan_text, kLongestLine,
                      "Legend of the section by the plan, which the key P shows")
          .flag("slices", &D::slices,
                "Whether slices through the tip, as of a scan, stand beside the picture; the key C "
                "shows and hides them")
          .keys_of(&D::slice_window, slice_window_schema())
          .choice("quality", &D::quality,
                  {{"auto", std::nullopt},
                   {"plain", Quality::kPlain},
                   {"shaded", Quality::kShaded},
                   {"full", Quality::kFull}},
                  "Quality of the drilling's picture: plain light, with shadows, or full with "
                  "smoothed edges; auto: what the machine draws 27 times a second")
          .number("eye_distance", &D::eye_distance, {0.0, 0.1}, "m",
                  "Distance between the eyes, in the scene")
          .integer("stills", &D::stills, 2, 20,
                   "Number of stills of the bone's stages that can be shown")
          .check([](Table& table, D& d) {
            if (d.stills > 0 && !d.cavity) {
              table.reject("stills",
                           "needs a cavity, whose stages the stills show; add a table [cavity]");
            }
          });
  return schema;
}

const Schema<subject::SurgeonParameters>& surgeon_schema() {
  using P = subject::SurgeonParameters;
  static const auto schema =
      Schema<P>()
          .keys_of(&P::spread, skill_schema())
          .number("reaction", &P::reaction, {0.05, 10.0}, "s",
                  "Time from a tone of the nerve monitor, or a hint, until a virtual surgeon acts")
          .number("heeds_hints", &P::heeds, kFraction, "",
                  "Share of hints that a virtual surgeon heeds")
          .integer("power_button", &P::power_button, 0, 30,
                   "Button of the device with which a virtual surgeon turns the burr")
          .integer("next_button", &P::next_button, 0, 30,
                   "Button of the device with which a virtual surgeon takes the next tool")
          .integer("previous_button", &P::previous_button, 0, 30,
                   "Button of the device with which a virtual surgeon takes the tool before")
          .integer("look_button", &P::look_button, -1, 30,
                   "Button of the device with which a virtual surgeon turns the camera while held; "
                   "-1: never")
          .integer("finish_button", &P::finish_button, -1, 30,
                   "Button of the device with which a virtual surgeon ends the procedure; -1: the "
                   "time limit ends it");
  return schema;
}

const Schema<D>& bone_sound_schema() {
  static const auto schema = Schema<D>()
                                 .flag("card", &D::sound_card, "Whether sound is played live")
                                 .number("vibration_gain", &D::vibration_gain, {0.0, 100.0}, "",
                                         "Strength of the burr's vibration in the handle; 0: none")
                                 .tunable()
                                 .keys_of(&D::thin_bone, sound::thin_bone_schema());
  return schema;
}

const Schema<D>& feedback_schema() {
  static const auto schema =
      Schema<D>()
          .flag("page", &D::trainee_page,
                "Whether a page about the session is written beside the session's file at the end")
          .required()
          .text("study", &D::experts_study,
                "Folder of a study, relative to the definition, with whose experts the page "
                "compares the participant")
          .otherwise("none")
          .text("score", &D::score_file,
                "File of a score, relative to the definition, as haptrial bone score writes it, "
                "by which the page scores the participant")
          .otherwise("none")
          .text("phases", &D::phases_file,
                "File of phases, relative to the definition, as haptrial bone phases writes it, by "
                "which the page divides the procedure")
          .otherwise("none")
          .text("checklist", &D::checklist_file,
                "File of a checklist, relative to the definition, whose items the page fills in by "
                "their measures")
          .otherwise("none");
  return schema;
}

static std::vector<double> read_margins(Table& table) {
  return table.numbers("margins", {0.0, 0.01}, "m");
}

const Schema<subject::CavityParameters>& cavity_schema() {
  using P = subject::CavityParameters;
  static const auto schema =
      Schema<P>()
          .direction("inward", &P::inward, "Direction into the bone in which the cavity narrows")
          .otherwise("towards the structure that it ends at")
          .text("beside", &P::beside, "Structure of the bone beside which the cavity ends")
          .vector("offset", &P::offset_B, {-1.0, 1.0}, "m",
                  "Offset of the cavity's end from the middle of the structure beside it, in the "
                  "bone's frame")
          .otherwise("[-0.002, 0.007, 0.001]")
          .number("radius", &P::radius, {1e-4, 0.02}, "m", "Radius of the cavity at its end")
          .number("slope", &P::slope, {0.0, 5.0}, "",
                  "Growth of the cavity's radius with the height above its end")
          .number("margin", &P::margin, {0.0, 0.01}, "m",
                  "Bone that is to stay between the cavity and any structure")
          .texts("structures", &P::structures, "Structures that have margins of their own")
          .otherwise("none")
          .custom("margins",
                  "Bone that is to stay at each of the structures that have margins of their own",
                  [](Table& table, const std::string&, P& p) { p.margins = read_margins(table); })
          .otherwise("none")
          .check([](Table& table, P& p) {
            if (table.has("margins") && !table.has("structures")) {
              p.structures = table.texts("structures");
            } else if (table.has("structures") && !table.has("margins")) {
              p.margins = read_margins(table);
            }
            if (p.margins.size() != p.structures.size()) {
              table.reject("margins",
                           fmt::format("has {} numbers; write one for each of the {} structures",
                                       p.margins.size(), p.structures.size()));
              p.margins.resize(p.structures.size(), 0.0);
            }
          });
  return schema;
}

}  // namespace haptrial::protocols
