#include "render/rod_batch.h"

#include <algorithm>
#include <cmath>

namespace shaken::render {
namespace {

std::array<float, 3> to_floats(double a, double b, double c) {
  return {static_cast<float>(a), static_cast<float>(b), static_cast<float>(c)};
}

/// The distance of neighbouring beads, or 0 if it is not the same all along the rod.
double pitch_of(const BeadRow& row) {
  if (row.offset.size() < 2) return 0;
  const double pitch = row.offset[1] - row.offset[0];
  for (std::size_t i = 1; i < row.offset.size(); ++i) {
    if (std::abs(row.offset[i] - row.offset[i - 1] - pitch) > 1e-3 * pitch) return 0;
  }
  return std::max(pitch, 0.0);
}

}  // namespace

RodInstance::RodInstance(const Vec3& at, const Vec3& director, const Colour& of)
    : centre(to_floats(at.x(), at.y(), at.z())),
      axis(to_floats(director.x(), director.y(), director.z())),
      colour(to_floats(of[0], of[1], of[2])) {}

RodBatch::RodBatch(const BeadRow& row)
    : ends(row.offset.front(), row.offset.back()), pitch(pitch_of(row)), half(row.reach()) {
  for (std::size_t i = 0; i < row.offset.size(); ++i) {
    beads.push_back(static_cast<float>(row.offset[i]));
    beads.push_back(static_cast<float>(row.radius[i]));
    thick = std::max(thick, row.radius[i]);
  }
}

void RodBatch::draw(GLuint program) const {
  const auto at = [program](const char* name) { return glGetUniformLocation(program, name); };
  const auto n_beads = static_cast<GLsizei>(beads.size() / 2);
  glUniform2fv(at("beads"), n_beads, beads.data());
  glUniform1i(at("n_beads"), n_beads);
  glUniform2f(at("ends"), static_cast<float>(ends.x()), static_cast<float>(ends.y()));
  glUniform1f(at("pitch"), static_cast<float>(pitch));
  glUniform1f(at("thick"), static_cast<float>(thick));
  draw_quads(rods);
}

void draw_quads(const std::vector<RodInstance>& instances) {
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(instances.size() * sizeof(RodInstance)), instances.data(),
               GL_STREAM_DRAW);
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(instances.size()));
}

RodBuffer::RodBuffer() {
  glGenVertexArrays(1, &vertex_array_);
  glGenBuffers(1, &buffer_);
  bind();
  for (GLuint i = 0; i < 3; ++i) {
    glEnableVertexAttribArray(i);
    // OpenGL takes an offset into the buffer as a pointer.
    glVertexAttribPointer(i, 3, GL_FLOAT, GL_FALSE, sizeof(RodInstance),
                          // NOLINTNEXTLINE(performance-no-int-to-ptr)
                          reinterpret_cast<const void*>(i * sizeof(RodInstance::centre)));
    glVertexAttribDivisor(i, 1);
  }
}

void RodBuffer::bind() const {
  glBindVertexArray(vertex_array_);
  glBindBuffer(GL_ARRAY_BUFFER, buffer_);
}

}  // namespace shaken::render
