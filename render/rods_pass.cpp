// SPDX-License-Identifier: MIT
#include "render/rods_pass.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "render/colourings.h"
#include "render/colours.h"
#include "render/gl.h"
#include "render/gl_program.h"
#include "render/rods_shaders.h"
#include "render/view.h"

namespace shaken::render {
namespace {

/// One rod as the shaders see it.
struct Instance {
  std::array<float, 3> centre, axis, colour;
};

std::array<float, 3> to_floats(const Vec3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

/// All rods of one species, and their periodic images, of which a part may lie in the view. `reach` is how far from its
/// centre anything of a rod is drawn.
std::vector<Instance> instances_in(const RodPicture& picture, std::size_t species, const View& view,
                                   const PictureStyle& style, double reach) {
  std::vector<Instance> instances;
  const std::size_t n = picture.count(species);
  instances.reserve(n + n / 4);
  const Colouring& colouring = colouring_of(picture, style);
  const Vec2 range = range_of(colouring, style);
  for (std::size_t i = 0; i < picture.n_rods(); ++i) {
    if (picture.species_of(i) != species) continue;
    const Vec3& x = picture.position[i];
    const Colour colour = rod_colour(picture, i, colouring, range);
    for_images(view, x.head<2>(), reach, [&](const Vec2& at) {
      instances.push_back({to_floats({at.x(), at.y(), x.z()}), to_floats(picture.director[i]),
                           to_floats({colour[0], colour[1], colour[2]})});
    });
  }
  return instances;
}

/// The rods of one species in the view.
struct Batch {
  std::vector<float> beads;  // offset, radius of each
  Vec2 ends;                 // offsets of the first and the last bead
  double pitch = 0;          // distance of neighbouring beads; 0 if it is not the same everywhere
  double thick = 0;          // greatest radius
  double margin = 0;         // of the shadow
  std::vector<Instance> instances;

  Batch(const RodPicture& picture, std::size_t species, const View& view, const PictureStyle& style) {
    const BeadRow& row = picture.beads_of(species);
    double half = 0;
    for (std::size_t i = 0; i < row.offset.size(); ++i) {
      beads.push_back(static_cast<float>(row.offset[i]));
      beads.push_back(static_cast<float>(row.radius[i]));
      half = std::max(half, std::abs(row.offset[i]) + row.radius[i]);
    }
    ends = Vec2(row.offset.front(), row.offset.back());
    pitch = pitch_of(row);
    thick = *std::max_element(row.radius.begin(), row.radius.end());
    margin = 1.1 * thick;
    instances = instances_in(picture, species, view, style, half + 2 * margin);
  }
};

}  // namespace

Result<void> check_drawable(const RodPicture& picture, int side) {
  if (side < 1 || side > RodsPass::kMaxSide) {
    return Error{"the box would be " + std::to_string(side) + " pixels wide; possible are 1 to " +
                 std::to_string(RodsPass::kMaxSide)};
  }
  if (!(picture.box_side > 0)) return Error{"the box has no size"};
  if (picture.director.size() != picture.position.size()) return Error{"as many directors as positions are needed"};
  for (std::size_t species = 0; species < picture.n_species(); ++species) {
    const BeadRow& beads = picture.beads_of(species);
    if (beads.offset.empty() || beads.offset.size() != beads.radius.size() ||
        beads.offset.size() > RodsPass::kMaxBeads) {
      return Error{"a rod of " + std::to_string(beads.offset.size()) + " beads cannot be drawn; possible are 1 to " +
                   std::to_string(RodsPass::kMaxBeads)};
    }
  }
  if (picture.n_species() > 1 && picture.species_of_rod.size() != picture.n_rods())
    return Error{"each rod's species is needed"};
  if (std::any_of(picture.species_of_rod.begin(), picture.species_of_rod.end(),
                  [&](std::uint8_t species) { return species >= picture.n_species(); })) {
    return Error{"a rod is of a species whose beads are not given"};
  }
  return {};
}

double pitch_of(const BeadRow& row) {
  if (row.offset.size() < 2) return 0;
  const double pitch = row.offset[1] - row.offset[0];
  for (std::size_t i = 1; i < row.offset.size(); ++i) {
    if (std::abs(row.offset[i] - row.offset[i - 1] - pitch) > 1e-3 * pitch) return 0;
  }
  return std::max(pitch, 0.0);
}

struct RodsPass::Programs {
  GLuint body = 0;
  GLuint shadow = 0;
  GLuint walls = 0;
  GLuint vertex_array = 0;
  GLuint buffer = 0;
};

RodsPass::RodsPass(GlContext context, std::unique_ptr<Programs> programs)
    : context_(std::move(context)), programs_(std::move(programs)) {}
RodsPass::RodsPass(RodsPass&&) noexcept = default;
RodsPass& RodsPass::operator=(RodsPass&&) noexcept = default;
RodsPass::~RodsPass() = default;  // the GL objects go with their context

Result<RodsPass> RodsPass::create() {
  Result<GlContext> context = GlContext::create();
  if (!context) return context.error();
  if (auto done = context->bind(kSamples, kSamples); !done) return done.error();
  auto programs = std::make_unique<Programs>();
  std::string message;
  programs->body = link_program(shaders::kQuad, shaders::kBody, message);
  programs->shadow = link_program(shaders::kQuad, shaders::kShadow, message);
  programs->walls = link_program(shaders::kView, shaders::kWalls, message);
  if (!programs->body || !programs->shadow || !programs->walls)
    return Error{"the rasteriser refuses a shader: " + message};

  glGenVertexArrays(1, &programs->vertex_array);
  glBindVertexArray(programs->vertex_array);
  glGenBuffers(1, &programs->buffer);
  glBindBuffer(GL_ARRAY_BUFFER, programs->buffer);
  for (GLuint i = 0; i < 3; ++i) {
    glEnableVertexAttribArray(i);
    // OpenGL takes an offset into the buffer as a pointer.
    glVertexAttribPointer(i, 3, GL_FLOAT, GL_FALSE, sizeof(Instance),
                          // NOLINTNEXTLINE(performance-no-int-to-ptr)
                          reinterpret_cast<const void*>(i * sizeof(Instance::centre)));
    glVertexAttribDivisor(i, 1);
  }
  return RodsPass(std::move(*context), std::move(programs));
}

Result<Image> RodsPass::draw(const RodPicture& picture, const PictureStyle& style, int side) {
  if (auto done = check_drawable(picture, side); !done) return done.error();
  if (auto done = context_.bind(side * kSamples, side * kSamples); !done) return done.error();

  const View view = view_of(picture, style);
  std::vector<Batch> batches;
  double thick = 0;
  for (std::size_t species = 0; species < picture.n_species(); ++species) {
    batches.emplace_back(picture, species, view, style);
    thick = std::max(thick, batches.back().thick);
  }
  const Palette colours = palette(style.theme);
  const auto set_colour = [](GLint at, const Colour& colour) {
    glUniform3f(at, static_cast<float>(colour[0]), static_cast<float>(colour[1]), static_cast<float>(colour[2]));
  };
  glBindVertexArray(programs_->vertex_array);
  glBindBuffer(GL_ARRAY_BUFFER, programs_->buffer);
  const auto draw_with = [&](GLuint program, const Batch& batch, double margin, const Vec2& shift) {
    const auto at = [&](const char* name) { return glGetUniformLocation(program, name); };
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(batch.instances.size() * sizeof(Instance)),
                 batch.instances.data(), GL_STREAM_DRAW);
    glUseProgram(program);
    const auto n_beads = static_cast<GLsizei>(batch.beads.size() / 2);
    glUniform2fv(at("beads"), n_beads, batch.beads.data());
    glUniform1i(at("n_beads"), n_beads);
    glUniform2f(at("ends"), static_cast<float>(batch.ends.x()), static_cast<float>(batch.ends.y()));
    glUniform1f(at("pitch"), static_cast<float>(batch.pitch));
    glUniform1f(at("thick"), static_cast<float>(batch.thick));
    glUniform1f(at("view_side"), static_cast<float>(view.side));
    glUniform1f(at("margin"), static_cast<float>(margin));
    glUniform2f(at("shift"), static_cast<float>(shift.x()), static_cast<float>(shift.y()));
    // A rod may stand up by as much as the lid lets it; a little more than that is spanned on either side.
    glUniform1f(at("low"), static_cast<float>(-thick));
    glUniform1f(at("high"), static_cast<float>(std::max(picture.gap, 2 * thick) + thick));
    set_colour(at("floor_colour"), colours.floor);
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(batch.instances.size()));
  };
  const auto draw_walls = [&](const SideWalls& walls) {
    const GLuint program = programs_->walls;
    const auto at = [&](const char* name) { return glGetUniformLocation(program, name); };
    glUseProgram(program);
    glUniform1i(at("arena"), walls.arena == Arena::kDisc ? 0 : walls.arena == Arena::kSquare ? 1 : 2);
    glUniform1f(at("size"), static_cast<float>(walls.size));
    glUniform1f(at("inner"), static_cast<float>(walls.inner));
    glUniform1f(at("box_side"), static_cast<float>(picture.box_side));
    glUniform1f(at("view_side"), static_cast<float>(view.side));
    glUniform2f(at("view_corner"), static_cast<float>(view.corner.x()), static_cast<float>(view.corner.y()));
    glUniform1f(at("line"), static_cast<float>(std::max(1.0, side / 480.0) * view.side / side));
    set_colour(at("wall_colour"), colours.walls);
    set_colour(at("line_colour"), colours.ink);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  };

  glClearColor(static_cast<float>(colours.floor[0]), static_cast<float>(colours.floor[1]),
               static_cast<float>(colours.floor[2]), 1);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);

  // Shadows do not add up: the darkest counts, so their order does not matter.
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_BLEND);
  glBlendEquation(GL_MIN);
  for (const Batch& batch : batches) {
    draw_with(programs_->shadow, batch, batch.margin, Vec2(0.20, -0.24) * batch.thick);
  }

  glDisable(GL_BLEND);
  if (picture.walls) draw_walls(*picture.walls);
  glEnable(GL_DEPTH_TEST);
  for (const Batch& batch : batches) draw_with(programs_->body, batch, 0, Vec2(0, 0));

  const std::vector<std::uint8_t>& pixels = context_.finished_pixels();
  if (const GLenum code = glGetError(); code != GL_NO_ERROR) {
    return Error{"OpenGL error " + std::to_string(code) + " while drawing " + std::to_string(picture.n_rods()) +
                 " rods"};
  }
  return averaged(pixels, side, side);
}

}  // namespace shaken::render
