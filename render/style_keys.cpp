#include "render/style_keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "base/picture_limits.h"
#include "render/colourings.h"
#include "render/style_file.h"

namespace shaken::render {
namespace {

using keys::at, keys::Form, keys::on_or_off, keys::plain, keys::Value;

template <auto... steps>
StyleKey number(const char* name, const char* value_name, double low, double high, const char* doc,
                keys::Dimension dimension = keys::Dimension::kPlain) {
  StyleKey key = keys::quantity(name, at<steps...>, dimension, low, high, doc);
  key.value_name = value_name;
  return key;
}

/// Two numbers, whatever they are.
template <auto... steps>
StyleKey pair(const char* name, const char* value_name, const char* doc) {
  return plain({.path = name, .form = Form::kPair, .low = -1e6, .high = 1e6, .value_name = value_name, .doc = doc},
               at<steps...>);
}

/// A member whose values are counted from 0, each with its word.
template <auto member>
StyleKey word(const char* name, std::initializer_list<const char*> words, const char* doc) {
  using Enum = std::remove_cvref_t<decltype(PictureStyle{}.*member)>;
  std::vector<std::pair<std::string, Enum>> choices;
  for (const char* each : words) choices.emplace_back(each, static_cast<Enum>(choices.size()));
  return choice(name, at<member>, choices, doc);
}

/// A preset to begin with: it says all that the other keys do not.
StyleKey preset() {
  StyleKey key{{.path = "style", .form = Form::kName, .fallback_note = "none", .doc = "A preset to begin with"}};
  for (const Preset& each : presets()) key.names.emplace_back(each.name);
  key.store = [](PictureStyle& style, const Value& name) { style = *named_style(std::get<std::string>(name), style); };
  return key;
}

StyleKey colour() {
  StyleKey key = plain({.path = "colour", .form = Form::kName, .names = colour_names(), .doc = "What colours a rod"},
                       at<&PictureStyle::colour>);
  // a range belongs to the colour that it stands with
  key.store = [set = key.store](PictureStyle& style, const Value& name) {
    set(style, name);
    style.range.reset();
  };
  return key;
}

Value fetch_view(const PictureStyle& style) {
  if (style.followed) return fmt::format("follow:{}", *style.followed);
  if (style.view == ViewPoint::kOrbit) return fmt::format("orbit:{:g},{:g}", style.orbit.x(), style.orbit.y());
  if (!style.followed_defect) return std::string(style.view == ViewPoint::kGap ? "gap" : "top");
  const auto& [charge, rank] = *style.followed_defect;
  return fmt::format("follow:{}{}", charge > 0 ? "plus" : "minus", rank > 0 ? fmt::format(":{}", rank) : "");
}

void store_view(PictureStyle& style, const Value& value) {
  const auto& word = std::get<std::string>(value);
  style.view = word == "gap" ? ViewPoint::kGap : word.starts_with("orbit") ? ViewPoint::kOrbit : ViewPoint::kTop;
  style.followed.reset();
  style.followed_defect.reset();
  if (word.starts_with("orbit:")) {
    const std::size_t comma = word.find(',');
    style.orbit = Vec2(std::stod(word.substr(6, comma - 6)), std::stod(word.substr(comma + 1)));
  }
  if (!word.starts_with("follow:")) return;
  const std::string what = word.substr(word.find(':') + 1);
  if (const std::size_t colon = what.find(':'); what.front() == 'p' || what.front() == 'm') {
    style.followed_defect = {what.front() == 'p' ? 0.5 : -0.5,
                             colon == std::string::npos ? 0 : std::stoul(what.substr(colon + 1))};
  } else {
    style.followed = std::stoi(what);
  }
  // A close-up, unless the style says how close.
  if (style.zoom <= 1) style.zoom = 4;
}

StyleKey view() {
  return {{.path = "view",
           .form = Form::kText,
           .pattern = "top|gap|orbit(:-?[0-9]{1,3}([.][0-9]{1,3})?,[0-9]{1,2}([.][0-9]{1,3})?)?|"
                      "follow:([0-9]{1,7}|(plus|minus)(:[0-9]{1,7})?)",
           .longest = 24,
           .expected = "top, gap, orbit:AZIMUTH,ELEVATION (degrees), follow:N (N counts rods from 0), follow:plus or "
                       "follow:minus",
           .value_name = "top|gap|orbit:AZ,EL|follow:N|follow:plus|follow:minus",
           .doc = "top: from above; gap: into the gap, in perspective; orbit:AZ,EL: the whole box in perspective, from "
                  "AZ degrees round it (0: from below the picture, 90: from its right) and EL degrees above the plate; "
                  "follow:N: rod N stays in the middle, 4 times enlarged unless zoom says otherwise; follow:plus, "
                  "follow:minus: the defect of that sign that lives "
                  "longest, follow:plus:1 the next one"},
          fetch_view,
          store_view};
}

std::vector<StyleKey> rows() {
  using Style = PictureStyle;
  return {
      preset(),
      size("size", at<&Style::width>, at<&Style::height>, kLeastPixels, kMostPixels,
           "Pixels; wide, square and tall pictures are laid out differently"),
      derived(number<&Style::dpi>("dpi", "N", 1, 10000,
                                  "Pixels per inch that a PNG or a PDF says it has: 1051 pixels at 300 are 89 mm"),
              "none"),
      colour(),
      pair<&Style::range>("range", "LOW,HIGH", "Ends of the colour scale, in its unit (--range=-5,5)"),
      word<&Style::palette>("palette", {"safe", "paper"},
                            "Colours of the two sides of the director: orange and blue, which the colour-blind tell "
                            "apart, or the paper's red and magenta"),
      word<&Style::theme>("theme", {"light", "dark", "print"}, "Colours of page, floor and text"),
      on_or_off(
          "transparent", at<&Style::transparent>,
          "No page and no floor, for slides and posters: a PNG then has an alpha channel (not films, not --depth 16)"),
      number<&Style::rods>("rods", "OPACITY", 0, 1, "Opacity of the rods over the background; 0: none"),
      keys::whole("samples", at<&Style::light, &Light::samples>, 1, 3,
                  "Rays along each side of a pixel; 1 is for a first look"),
      on_or_off("shadows", at<&Style::light, &Light::shadows>, "Soft shadows on the floor"),
      on_or_off("gloss", at<&Style::light, &Light::gloss>, "Rods shine where they throw the light back"),
      on_or_off("occlusion", at<&Style::light, &Light::occlusion>,
                "Rods are darker at their sides, which see neighbours rather than the sky"),
      on_or_off("smooth", at<&Style::light, &Light::smooth>,
                "Rods look like smooth bodies; else each of their beads is seen"),
      word<&Style::background>("background", {"none", "order"},
                               "What lies under the rods: the floor, or the local order S (dark: none)"),
      word<&Style::lines>("lines", {"none", "bars", "streamlines"}, "The director field over the rods"),
      on_or_off("defects", at<&Style::mark_defects>, "Looks for defects and marks them: +1/2 comets, -1/2 three arms"),
      number<&Style::tracks>("tracks", "S", 0, 1000, "For how long defects leave a track that fades",
                             keys::Dimension::kTime),
      number<&Style::displacements>("displacements", "S", 0, 1e6,
                                    "Arrows from where each rod's centre was so long before", keys::Dimension::kTime),
      word<&Style::inset>("inset", {"none", "angles", "order", "sweep"},
                          "A plot in a corner of the rods: P(theta) of this instant; S(t), "
                          "which then stands there only; the points of the sweep with a ring round this one"),
      on_or_off("caption", at<&Style::caption>, "Headline, numbers and S(t)"),
      on_or_off("legend", at<&Style::legend>, "The colour scale, with how many rods have which colour"),
      on_or_off("scale_bar", at<&Style::scale_bar>, "A scale bar; in films also the playback speed"),
      view(),
      on_or_off("whole", at<&Style::whole>,
                "Rods across the border of a periodic box are drawn once and whole, beyond its frame, and not as two "
                "pieces; in the view from above that shows all of the box"),
      number<&Style::zoom>("zoom", "FACTOR", 1, 1000, "Shows a part of the box, this many times enlarged"),
      pair<&Style::focus>("focus", "X,Y", "Middle of the enlarged part, in box sides"),
      number<&Style::fps>("fps", "N", 0.1, 1000, "Frames per second of playing"),
      derived(number<&Style::speed>("speed", "FACTOR", 1e-6, 1e6,
                                    "Simulated seconds per second of playing, 0.1 for slow motion"),
              "recorded frames follow each other as `movie.every` says"),
      on_or_off("interpolate", at<&Style::interpolate>,
                "Frames of a film that lie between recorded ones show rods on their straight way from one to the "
                "other; else the recorded frame nearest in time is shown"),
      on_or_off("time_bar", at<&Style::time_bar>, "A bar at the lower edge of a film: how far it is"),
      on_or_off("small", at<&Style::small>, "A film of about a third of the size, coarser where much moves (not .gif)"),
  };
}

}  // namespace

const keys::Table<PictureStyle>& style_keys() {
  static const keys::Table<PictureStyle> table(rows());
  return table;
}

std::string option_of(const StyleKey& key) {
  std::string name = key.path;
  std::replace(name.begin(), name.end(), '_', '-');
  return name;
}

bool is_for_films(const StyleKey& key) {
  static const std::set<std::string> names{"fps", "speed", "interpolate", "time_bar", "small"};
  return names.contains(key.path);
}

std::string flags_of(const StyleKey& key) { return (key.path == "colour" ? "-c,--" : "--") + option_of(key); }

Result<void> set_from_text(PictureStyle& style, const StyleKey& key, const std::string& text) {
  std::vector<keys::Problem> problems;
  const keys::Given given = read_text(key, text, problems);
  if (!given.ok) return Error{problems.front().message};
  key.store(style, given.value);
  return {};
}

}  // namespace shaken::render
