// SPDX-License-Identifier: MIT
#include "render/rods_pass.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "render/colourings.h"
#include "render/colours.h"
#include "render/gl.h"
#include "render/gl_program.h"
#include "render/rod_batch.h"
#include "render/rods_shaders.h"
#include "render/view.h"

namespace shaken::render {
namespace {

/// A batch, with what the view from above adds to it.
struct SeenFromAbove : RodBatch {
  using RodBatch::RodBatch;
  double margin = 1.1 * thick;  ///< of the shadow
};

/// All rods of one species, and their periodic images, of which a part may lie in the view.
SeenFromAbove batch_of(const RodPicture& picture, std::size_t species, const View& view, const PictureStyle& style) {
  SeenFromAbove batch(picture.cell.species[species]);
  const std::size_t n = picture.count(species);
  batch.rods.reserve(n + n / 4);
  const Colouring& colouring = colouring_of(picture, style);
  const Vec2 range = range_of(colouring, style);
  for (std::size_t i = 0; i < picture.n_rods(); ++i) {
    if (picture.cell.species_of(i) != species) continue;
    const Vec3& x = picture.position[i];
    const Colour colour = rod_colour(picture, i, colouring, range);
    for_images(view, x.head<2>(), batch.half + 2 * batch.margin, [&](const Vec2& at) {
      batch.rods.emplace_back(Vec3(at.x(), at.y(), x.z()), picture.director[i], colour);
    });
  }
  return batch;
}

}  // namespace

Result<void> check_drawable(const RodPicture& picture, int side) {
  if (side < 1 || side > RodsPass::kMaxSide) {
    return Error{"the box would be " + std::to_string(side) + " pixels wide; possible are 1 to " +
                 std::to_string(RodsPass::kMaxSide)};
  }
  if (!(picture.cell.box_side > 0)) return Error{"the box has no size"};
  if (picture.director.size() != picture.position.size()) return Error{"as many directors as positions are needed"};
  for (const BeadRow& beads : picture.cell.species) {
    if (beads.offset.empty() || beads.offset.size() != beads.radius.size() ||
        beads.offset.size() > RodsPass::kMaxBeads) {
      return Error{"a rod of " + std::to_string(beads.offset.size()) + " beads cannot be drawn; possible are 1 to " +
                   std::to_string(RodsPass::kMaxBeads)};
    }
  }
  if (picture.cell.species.size() > 1 && picture.cell.species_of_rod.size() != picture.n_rods())
    return Error{"each rod's species is needed"};
  if (std::any_of(picture.cell.species_of_rod.begin(), picture.cell.species_of_rod.end(),
                  [&](std::uint8_t species) { return species >= picture.cell.species.size(); })) {
    return Error{"a rod is of a species whose beads are not given"};
  }
  return {};
}

struct RodsPass::Programs {
  GLuint body = 0;
  GLuint shadow = 0;
  GLuint walls = 0;
  std::string body_is_for;  ///< what light
  RodBuffer rods;
};

RodsPass::RodsPass(GlContext context, std::unique_ptr<Programs> programs)
    : context_(std::move(context)), programs_(std::move(programs)) {}
RodsPass::RodsPass(RodsPass&&) noexcept = default;
RodsPass& RodsPass::operator=(RodsPass&&) noexcept = default;
RodsPass::~RodsPass() = default;  // the GL objects go with their context

Result<RodsPass> RodsPass::create() {
  Result<GlContext> context = GlContext::create();
  if (!context) return context.error();
  if (auto done = context->bind(1, 1); !done) return done.error();
  auto programs = std::make_unique<Programs>();
  std::string message;
  programs->shadow = link_program(shaders::kQuad, shaders::kShadow, message);
  programs->walls = link_program(shaders::kView, shaders::kWalls, message);
  if (!programs->shadow || !programs->walls) return Error{"the rasteriser refuses a shader: " + message};
  return RodsPass(std::move(*context), std::move(programs));
}

template <class Channel>
Result<ImageOf<Channel>> RodsPass::draw(const RodPicture& picture, const PictureStyle& style, int side) {
  if (auto done = check_drawable(picture, side); !done) return done.error();
  if (auto done = context_.bind<Channel>(side * style.light.samples, side * style.light.samples); !done)
    return done.error();

  if (auto done = relight(programs_->body, programs_->body_is_for, shaders::kQuad, shaders::kBody, style.light);
      !done) {
    return done.error();
  }
  const View view = view_of(picture, style);
  std::vector<SeenFromAbove> batches;
  double thick = 0;
  for (std::size_t species = 0; species < picture.cell.species.size(); ++species) {
    batches.push_back(batch_of(picture, species, view, style));
    thick = std::max(thick, batches.back().thick);
  }
  const Palette colours = palette(style.theme);
  const auto set_colour = [](GLint at, const Colour& colour) {
    glUniform3f(at, static_cast<float>(colour[0]), static_cast<float>(colour[1]), static_cast<float>(colour[2]));
  };
  programs_->rods.bind();
  const auto draw_with = [&](GLuint program, const SeenFromAbove& batch, double margin, const Vec2& shift) {
    const auto at = [&](const char* name) { return glGetUniformLocation(program, name); };
    glUseProgram(program);
    glUniform1f(at("view_side"), static_cast<float>(view.side));
    glUniform1f(at("margin"), static_cast<float>(margin));
    glUniform2f(at("shift"), static_cast<float>(shift.x()), static_cast<float>(shift.y()));
    // A rod may stand up by as much as the lid lets it; a little more than that is spanned on either side.
    glUniform1f(at("low"), static_cast<float>(-thick));
    glUniform1f(at("high"), static_cast<float>(std::max(picture.cell.gap, 2 * thick) + thick));
    set_colour(at("floor_colour"), colours.floor);
    batch.draw(program);
  };
  const auto draw_walls = [&](const SideWalls& walls) {
    const GLuint program = programs_->walls;
    const auto at = [&](const char* name) { return glGetUniformLocation(program, name); };
    glUseProgram(program);
    glUniform1i(at("arena"), walls.arena == Arena::kDisc ? 0 : walls.arena == Arena::kSquare ? 1 : 2);
    glUniform1f(at("size"), static_cast<float>(walls.size));
    glUniform1f(at("inner"), static_cast<float>(walls.inner));
    glUniform1f(at("box_side"), static_cast<float>(picture.cell.box_side));
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
  for (const SeenFromAbove& batch : batches) {
    if (!style.light.shadows) break;
    draw_with(programs_->shadow, batch, batch.margin, Vec2(0.20, -0.24) * batch.thick);
  }

  glDisable(GL_BLEND);
  if (picture.cell.walls) draw_walls(*picture.cell.walls);
  glEnable(GL_DEPTH_TEST);
  for (const SeenFromAbove& batch : batches) draw_with(programs_->body, batch, 0, Vec2(0, 0));

  const std::vector<Channel>& pixels = context_.finished_pixels<Channel>();
  if (const GLenum code = glGetError(); code != GL_NO_ERROR) {
    return Error{"OpenGL error " + std::to_string(code) + " while drawing " + std::to_string(picture.n_rods()) +
                 " rods"};
  }
  return averaged(pixels, side, side, style.light.samples);
}
template Result<Image> RodsPass::draw(const RodPicture& picture, const PictureStyle& style, int side);
template Result<DeepImage> RodsPass::draw(const RodPicture& picture, const PictureStyle& style, int side);

}  // namespace shaken::render
