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
#include "render/rod_batch.h"
#include "render/rods_shaders.h"
#include "render/view.h"

namespace shaken::render {
namespace {

/// Where light comes from: over the left shoulder of who looks.
Vec3 light_in(const Camera& camera) { return -0.42 * camera.right + 0.50 * camera.up - 0.757 * camera.forward; }
/// The margin of shadows, in greatest radii.
constexpr double kMargin = 1.1;

/// What keeps a picture from being drawn, if anything.
Result<void> check_drawable(const RodPicture& picture, const PictureStyle& style, int width, int height) {
  if (std::min(width, height) < 1 || std::max(width, height) > RodsPass::kMaxSide) {
    return Error{"the rods would be " + std::to_string(width) + " x " + std::to_string(height) +
                 " pixels; possible are 1 to " + std::to_string(RodsPass::kMaxSide) + " each way"};
  }
  if (!(picture.cell.box.shorter() > 0)) return Error{"the box has no size"};
  if (style.view != ViewPoint::kTop && !(picture.cell.gap > 0)) return Error{"there is no gap to look into"};
  if (picture.frame.director.size() != picture.frame.position.size())
    return Error{"as many directors as positions are needed"};
  for (const BeadRow& beads : picture.cell.shapes) {
    if (beads.offset.empty() || beads.offset.size() != beads.radius.size() ||
        beads.offset.size() > RodsPass::kMostDrawnBeads) {
      return Error{"a rod of " + std::to_string(beads.offset.size()) + " beads cannot be drawn; possible are 1 to " +
                   std::to_string(RodsPass::kMostDrawnBeads)};
    }
  }
  if (picture.cell.shapes.size() > 1 && picture.cell.shape_of_rod.size() != picture.n_rods())
    return Error{"each rod's shape is needed"};
  if (std::any_of(picture.cell.shape_of_rod.begin(), picture.cell.shape_of_rod.end(),
                  [&](std::uint8_t shape) { return shape >= picture.cell.shapes.size(); })) {
    return Error{"a rod is of a shape whose beads are not given"};
  }
  return {};
}

/// Whether one sees where the floor ends: at side walls, or around a box that is not repeated.
bool has_end(const Cell& cell, const Camera& camera) {
  return cell.walls || (camera.period.isZero() && !camera.is_parallel);
}

/// All rods of one shape, and their periodic images, of which a part may be seen; relative to the eye.
RodBatch seen_rods(const RodPicture& picture, std::size_t shape, const PictureStyle& style, const Camera& camera) {
  const BeadRow& beads = picture.cell.shapes[shape];
  RodBatch batch(beads);
  const double around = camera.is_parallel ? batch.half + 2 * kMargin * batch.thick : batch.half;
  const std::size_t n = picture.count_of_shape(shape);
  batch.rods.reserve(n + n / 4);
  const Colouring& colouring = colouring_of(picture, style);
  const Vec2 range = range_of(colouring, style);
  for (std::size_t i = 0; i < picture.n_rods(); ++i) {
    if (picture.cell.shape_of(i) != shape) continue;
    const Vec3 &x = picture.frame.position[i], &n_rod = picture.frame.director[i];
    double towards = 0;  // how far the rod reaches towards the eye
    for (std::size_t k = 0; k < beads.offset.size(); ++k) {
      towards = std::max(towards, beads.radius[k] - beads.offset[k] * n_rod.dot(camera.forward));
    }
    const Colour colour = rod_colour(picture, i, colouring, range, style.palette);
    for_images(camera.low, camera.high, camera.period, x.head<2>(), around, [&](const Vec2& at) {
      const Vec3 place(at.x(), at.y(), x.z()), seen = camera.seen(place);
      if (!camera.is_parallel) {
        const Vec2 edge = camera.half * (seen.z() + batch.half) + Vec2(2, 2) * batch.half;
        if (seen.z() - towards < camera.nearest || seen.z() - batch.half > camera.farthest) return;
        if (std::abs(seen.x()) > edge.x() || std::abs(seen.y()) > edge.y()) return;
      }
      batch.rods.emplace_back(place - camera.eye, n_rod, colour);
    });
  }
  return batch;
}

/// All posts, and their periodic images, of which a part may be seen; relative to the eye.
std::vector<RodInstance> seen_posts(const StandingPosts& posts, const Camera& camera, const Colour& colour) {
  std::vector<RodInstance> seen;
  for (const Vec2& centre : posts.centres) {
    for_images(camera.low, camera.high, camera.period, centre, 0.5 * posts.diameter, [&](const Vec2& at) {
      seen.emplace_back(Vec3(at.x() - camera.eye.x(), at.y() - camera.eye.y(), 0), Vec3::UnitZ(), colour);
    });
  }
  return seen;
}

/// Hands over what all programs may ask for; `program` is then in use.
void set_scene(GLuint program, const Cell& cell, const Frame& frame, const PictureStyle& style, const Camera& camera,
               int height) {
  glUseProgram(program);
  const auto at = [program](const char* name) { return glGetUniformLocation(program, name); };
  const auto number = [&](const char* name, double value) { glUniform1f(at(name), static_cast<float>(value)); };
  const auto pair = [&](const char* name, double x, double y) {
    glUniform2f(at(name), static_cast<float>(x), static_cast<float>(y));
  };
  const auto three = [&](const char* name, const auto& of) {
    glUniform3f(at(name), static_cast<float>(of[0]), static_cast<float>(of[1]), static_cast<float>(of[2]));
  };
  std::array<float, 9> axes{};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    axes[i] = static_cast<float>(camera.right[k]);
    axes[3 + i] = static_cast<float>(camera.up[k]);
    axes[6 + i] = static_cast<float>(camera.forward[k]);
  }
  glUniformMatrix3fv(at("axes"), 1, GL_TRUE, axes.data());
  pair("half_view", camera.half.x(), camera.half.y());
  glUniform1i(at("is_parallel"), camera.is_parallel ? 1 : 0);
  three("forward", camera.forward);
  three("light", light_in(camera));
  const double first = camera.is_cut ? 0.5 * camera.nearest : camera.nearest;
  pair("depths", first, camera.farthest);
  number("nearest", camera.is_parallel ? -1e9 : camera.nearest);
  pair("fade", camera.nearest, camera.farthest);

  const double base = frame.base - camera.eye.z();
  pair("heights", camera.heights.x() - camera.eye.z(), camera.heights.y() - camera.eye.z());
  number("base", base);
  pair("plates", base, frame.lid ? *frame.lid - camera.eye.z() : base + cell.gap);
  glUniform1i(at("has_lid"), frame.has_lid ? 1 : 0);
  number("cut", camera.is_cut ? camera.nearest : 0);
  number("grid", camera.is_parallel ? 0 : 5);
  const Box plate = camera.fades || camera.is_parallel ? Box(1e6) : cell.box;
  pair("plate", plate.x(), plate.y());
  number("line", std::max(1.0, height / 480.0) * camera.pixel(height));
  const Arena arena = cell.walls ? cell.walls->arena : Arena::kSquare;
  const bool is_channel = arena == Arena::kChannel;  // which ends where the plates do
  const bool is_long = arena == Arena::kEllipse || arena == Arena::kWedge;
  const double width = cell.walls ? cell.walls->size : cell.box.y();
  const double length = is_channel ? plate.x() : is_long ? cell.walls->length : cell.walls ? width : cell.box.x();
  glUniform1i(at("is_round"), arena == Arena::kSquare || arena == Arena::kWedge || is_channel ? 0 : 1);
  pair("middle", cell.box.x() / 2 - camera.eye.x(), cell.box.y() / 2 - camera.eye.y());
  pair("size", length, width);
  number("narrow", arena == Arena::kWedge ? cell.walls->narrow : width);
  number("inner", arena == Arena::kAnnulus ? cell.walls->inner : 0);
  number("between", arena == Arena::kStadium ? cell.walls->length : 0);
  const PageColours colours = ground_colours(style);
  three("page", colours.page);
  three("floor_colour", colours.floor);
  three("cut_colour", colours.walls);
  three("outside", cell.walls ? colours.walls : colours.page);
  three("ink", colours.ink);
}

}  // namespace

struct RodsPass::Programs {
  explicit Programs(GlContext made) : context(std::move(made)) {}

  GlContext context;  // in which the others are made
  ProgramVariants plates{{shaders::kCamera, shaders::kStage}, {shaders::kFloor, shaders::kPlates}};
  ProgramVariants shadow{{shaders::kCamera, shaders::kShadowQuad}, {shaders::kFloor, shaders::kShadow}};
  ProgramVariants post{{shaders::kCamera, shaders::kPostQuad}, {shaders::kFloor, shaders::kPost}};
  ProgramVariants body{{shaders::kCamera, shaders::kQuad}, {shaders::kFloor, shaders::kBody}};
  RodBuffer rods;
};

RodsPass::RodsPass(std::unique_ptr<Programs> programs) : programs_(std::move(programs)) {}
RodsPass::RodsPass(RodsPass&&) noexcept = default;
RodsPass& RodsPass::operator=(RodsPass&&) noexcept = default;
RodsPass::~RodsPass() = default;

Result<RodsPass> RodsPass::create() {
  GlContext context = SHAKEN_TRY(GlContext::create());
  SHAKEN_TRY(context.bind(1, 1));
  return RodsPass(std::make_unique<Programs>(std::move(context)));
}

template <class Channel>
Result<ImageOf<Channel>> RodsPass::draw(const RodPicture& picture, const PictureStyle& style, int width, int height) {
  SHAKEN_TRY(check_drawable(picture, style, width, height));
  const Light& light = style.light;
  SHAKEN_TRY(programs_->context.bind<Channel>(width * light.samples, height * light.samples));
  const Camera camera = camera_of(picture, style, static_cast<double>(width) / height);
  std::string seen, lit;  // what has to be worked out of it
  if (camera.fades) seen += "#define FADES\n";
  if (has_end(picture.cell, camera)) seen += "#define ENDS\n";
  for (const auto& [name, is_on] :
       {std::pair{"GLOSS", light.gloss}, {"OCCLUSION", light.occlusion}, {"SMOOTH", light.smooth}}) {
    if (is_on) lit.append("#define ").append(name).append("\n");
  }
  const Result<GLuint> plates = programs_->plates.with(seen), shadow = programs_->shadow.with(seen),
                       post = programs_->post.with(seen), body = programs_->body.with(seen + lit);
  for (const Result<GLuint>* program : {&plates, &shadow, &post, &body}) {
    if (!*program) return program->error();
  }
  std::vector<RodBatch> batches;
  for (std::size_t shape = 0; shape < picture.cell.shapes.size(); ++shape) {
    batches.push_back(seen_rods(picture, shape, style, camera));
  }
  programs_->rods.bind();
  const auto draw_with = [&](GLuint program) {
    for (const RodBatch& batch : batches) {
      if (batch.rods.empty()) continue;
      set_scene(program, picture.cell, picture.frame, style, camera, height);
      const auto at = [&](const char* name) { return glGetUniformLocation(program, name); };
      const Vec2 shift = -0.48 * batch.thick * light_in(camera).head<2>();
      glUniform1f(at("margin"), static_cast<float>(kMargin * batch.thick));
      glUniform2f(at("shift"), static_cast<float>(shift.x()), static_cast<float>(shift.y()));
      batch.draw(program);
    }
  };
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_ALWAYS);
  glDisable(GL_BLEND);
  const Colour floor = ground_colours(style).floor;
  glClearColor(static_cast<float>(floor[0]), static_cast<float>(floor[1]), static_cast<float>(floor[2]), 1);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  if (!camera.is_parallel || picture.cell.walls) {  // else there is nothing but floor
    set_scene(*plates, picture.cell, picture.frame, style, camera, height);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  }
  glDepthFunc(GL_LESS);
  if (light.shadows) {
    // Shadows do not add up: the darkest counts, so their order does not matter.
    if (!camera.is_cut) glDisable(GL_DEPTH_TEST);  // nothing stands on the floor yet
    glDepthMask(GL_FALSE);
    glEnable(GL_BLEND);
    glBlendEquation(GL_MIN);
    draw_with(*shadow);
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
  }
  draw_with(*body);
  const StandingPosts& posts = picture.cell.posts;
  if (const auto seen_ones = seen_posts(posts, camera, ground_colours(style).walls); !seen_ones.empty()) {
    set_scene(*post, picture.cell, picture.frame, style, camera, height);
    glUniform1f(glGetUniformLocation(*post, "radius"), static_cast<float>(0.5 * posts.diameter));
    draw_quads(seen_ones);
  }

  const std::vector<Channel>& pixels = programs_->context.finished_pixels<Channel>();
  if (const GLenum code = glGetError(); code != GL_NO_ERROR) {
    return Error{"OpenGL error " + std::to_string(code) + " while drawing " + std::to_string(picture.n_rods()) +
                 " rods"};
  }
  return averaged(pixels, width, height, light.samples);
}
template Result<Image> RodsPass::draw(const RodPicture& picture, const PictureStyle& style, int width, int height);
template Result<DeepImage> RodsPass::draw(const RodPicture& picture, const PictureStyle& style, int width, int height);

}  // namespace shaken::render
