// SPDX-License-Identifier: MIT
#include "render/gap_pass.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "render/colourings.h"
#include "render/colours.h"
#include "render/gap_shaders.h"
#include "render/gl.h"
#include "render/gl_program.h"
#include "render/rod_batch.h"
#include "render/rods_pass.h"

namespace shaken::render {
namespace {

/// Rods of one species that are seen, with their periodic images, relative to the eye.
RodBatch seen_rods(const RodPicture& picture, std::size_t species, const PictureStyle& style, const GapCamera& camera) {
  const Colouring& colouring = colouring_of(picture, style);
  const Vec2 range = range_of(colouring, style);
  const BeadRow& beads = picture.cell.species[species];
  RodBatch seen(beads);
  const double half = seen.half;
  const double side = camera.tangent.x() * camera.far + half, period = picture.cell.box_side;
  for (std::size_t i = 0; i < picture.n_rods(); ++i) {
    if (picture.cell.species_of(i) != species) continue;
    const Vec3 from_eye = picture.position[i] - camera.eye;
    const Vec3& n = picture.director[i];
    // How far the rod reaches towards the eye.
    double towards = 0;
    for (std::size_t k = 0; k < beads.offset.size(); ++k) {
      towards = std::max(towards, beads.radius[k] - beads.offset[k] * n.y());
    }
    const auto add = [&](double x, double y) {
      if (y - towards < camera.front || y - half > camera.far) return;
      if (std::abs(x) > camera.tangent.x() * (y + half) + half) return;
      seen.rods.emplace_back(Vec3(x, y, from_eye.z()), n, rod_colour(picture, i, colouring, range));
    };
    if (picture.cell.walls) {
      add(from_eye.x(), from_eye.y());
      continue;
    }
    for (double ky = std::ceil((camera.front - from_eye.y()) / period); from_eye.y() + ky * period < camera.far + half;
         ++ky) {
      for (double kx = std::ceil((-side - from_eye.x()) / period); from_eye.x() + kx * period <= side; ++kx) {
        add(from_eye.x() + kx * period, from_eye.y() + ky * period);
      }
    }
  }
  return seen;
}

}  // namespace

GapCamera gap_camera(const RodPicture& picture, const PictureStyle& style, double aspect) {
  constexpr double kShare = 0.28;      // of the stage's height that the gap takes at the front
  constexpr double kDistance = 6.5;    // from the eye to the front, in gaps
  constexpr double kDepth = 22;        // from the front to where all has faded, in gaps
  constexpr double kEyeHeight = 0.66;  // above the base, in gaps
  GapCamera camera;
  camera.front = kDistance * picture.cell.gap;
  camera.far = camera.front + kDepth * picture.cell.gap;
  Vec2 at = style.focus * picture.cell.box_side;
  if (style.followed && static_cast<std::size_t>(*style.followed) < picture.n_rods()) {
    at = picture.position[static_cast<std::size_t>(*style.followed)].head<2>() - Vec2(0, 1.5 * picture.cell.gap);
  }
  // The eye rests, so that the plates are seen to move; a vibration is small against the gap.
  camera.eye = Vec3(at.x(), at.y() - camera.front, kEyeHeight * picture.cell.gap);
  const double up = picture.cell.gap / kShare / 2 / camera.front / std::max(style.zoom, 1.0);
  camera.tangent = Vec2(aspect * up, up);
  return camera;
}

struct GapPass::Programs {
  GLuint plates = 0, shadow = 0, body = 0;
  std::string body_is_for;  ///< what light
  RodBuffer rods;
};

GapPass::GapPass(GlContext context, std::unique_ptr<Programs> programs)
    : context_(std::move(context)), programs_(std::move(programs)) {}
GapPass::GapPass(GapPass&&) noexcept = default;
GapPass& GapPass::operator=(GapPass&&) noexcept = default;
GapPass::~GapPass() = default;  // the GL objects go with their context

Result<GapPass> GapPass::create() {
  Result<GlContext> context = GlContext::create();
  if (!context) return context.error();
  if (auto done = context->bind(1, 1); !done) return done.error();
  auto programs = std::make_unique<Programs>();
  std::string message;
  programs->plates = link_program(shaders::kStage, shaders::kPlates, message);
  programs->shadow = link_program(shaders::kGapShadowQuad, shaders::kGapShadow, message);
  if (!programs->plates || !programs->shadow) return Error{"the rasteriser refuses a shader: " + message};
  return GapPass(std::move(*context), std::move(programs));
}

template <class Channel>
Result<ImageOf<Channel>> GapPass::draw(const RodPicture& picture, const PictureStyle& style, int width, int height) {
  if (auto done = check_drawable(picture, std::max(width, height)); !done) return done.error();
  if (!(picture.cell.gap > 0)) return Error{"there is no gap to look into"};
  if (auto done = context_.bind<Channel>(width * style.light.samples, height * style.light.samples); !done)
    return done.error();
  if (auto done = relight(programs_->body, programs_->body_is_for, shaders::kGapRod, shaders::kGapBody, style.light);
      !done) {
    return done.error();
  }
  const GapCamera camera = gap_camera(picture, style, static_cast<double>(width) / height);
  const Palette colours = palette(style.theme);
  const double base = picture.base - camera.eye.z();
  const auto f = [](double x) { return static_cast<float>(x); };
  const auto use = [&](GLuint program) {
    glUseProgram(program);
    const auto at = [program](const char* name) { return glGetUniformLocation(program, name); };
    glUniform2f(at("tangent"), f(camera.tangent.x()), f(camera.tangent.y()));
    glUniform2f(at("plates"), f(base), f(base + picture.cell.gap));
    glUniform2f(at("depths"), f(0.5 * camera.front), f(camera.far));
    glUniform1f(at("front"), f(camera.front));
    for (const auto& [name, colour] : {std::pair{"page", colours.page},
                                       {"face", colours.floor},
                                       {"cut", colours.walls},
                                       {"ink", colours.ink},
                                       {"haze", colours.page}}) {
      glUniform3f(at(name), f(colour[0]), f(colour[1]), f(colour[2]));
    }
    return at;
  };
  programs_->rods.bind();
  glClearColor(f(colours.page[0]), f(colours.page[1]), f(colours.page[2]), 1);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  glDisable(GL_BLEND);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  {
    const auto at = use(programs_->plates);
    glUniform1i(at("has_lid"), picture.has_lid ? 1 : 0);
    glUniform2f(at("origin"), f(-camera.eye.x()), f(-camera.eye.y()));
    glUniform1f(at("thickness"), f(0.8 * picture.cell.gap));
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  }
  std::vector<RodBatch> batches;
  for (std::size_t species = 0; species < picture.cell.species.size(); ++species) {
    batches.push_back(seen_rods(picture, species, style, camera));
  }
  const auto draw_with = [&](GLuint program, const RodBatch& batch) {
    if (batch.rods.empty()) return;
    glUniform1f(use(program)("margin"), f(0.7 * batch.thick));
    batch.draw(program);
  };
  // On the base, but not on its cut edge, which is at depth 0. The darkest counts nowhere: shadows add up.
  glDepthMask(GL_FALSE);
  glEnable(GL_BLEND);
  glBlendEquation(GL_FUNC_ADD);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  if (style.light.shadows) {
    for (const RodBatch& batch : batches) draw_with(programs_->shadow, batch);
  }
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  for (const RodBatch& batch : batches) draw_with(programs_->body, batch);

  const std::vector<Channel>& pixels = context_.finished_pixels<Channel>();
  if (const GLenum code = glGetError(); code != GL_NO_ERROR) {
    return Error{"OpenGL error " + std::to_string(code) + " while looking into the gap"};
  }
  return averaged(pixels, width, height, style.light.samples);
}
template Result<Image> GapPass::draw(const RodPicture& picture, const PictureStyle& style, int width, int height);
template Result<DeepImage> GapPass::draw(const RodPicture& picture, const PictureStyle& style, int width, int height);

}  // namespace shaken::render
