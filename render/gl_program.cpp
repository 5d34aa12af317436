// SPDX-License-Identifier: MIT
#include "render/gl_program.h"

#include <algorithm>
#include <array>
#include <type_traits>
#include <utility>

namespace shaken::render {

GLuint link_program(const char* vertex_source, const char* fragment_source, std::string& message,
                    const std::string& defines) {
  // They come after the line that names the version.
  std::string fragment = fragment_source;
  fragment.insert(fragment.find('\n') + 1, defines);
  const GLuint program = glCreateProgram();
  for (const auto& [species, source] :
       {std::pair{GL_VERTEX_SHADER, vertex_source}, std::pair{GL_FRAGMENT_SHADER, fragment.c_str()}}) {
    const GLuint shader = glCreateShader(static_cast<GLenum>(species));
    glShaderSource(shader, 1, &source, nullptr);
    glCompileShader(shader);
    glAttachShader(program, shader);
    glDeleteShader(shader);
  }
  glLinkProgram(program);
  GLint linked = GL_FALSE;
  glGetProgramiv(program, GL_LINK_STATUS, &linked);
  if (linked) return program;
  std::array<char, 2048> text{};
  glGetProgramInfoLog(program, static_cast<GLsizei>(text.size()), nullptr, text.data());
  message = text.data();
  glDeleteProgram(program);
  return 0;
}

Result<void> relight(GLuint& program, std::string& made_for, const char* vertex_source, const char* fragment_source,
                     const Light& light) {
  std::string defines;
  for (const auto& [name, is_on] :
       {std::pair{"GLOSS", light.gloss}, {"OCCLUSION", light.occlusion}, {"SMOOTH", light.smooth}}) {
    if (is_on) defines.append("#define ").append(name).append("\n");
  }
  if (program != 0 && made_for == defines) return {};
  glDeleteProgram(program);
  std::string message;
  program = link_program(vertex_source, fragment_source, message, defines);
  made_for = defines;
  return program != 0 ? Result<void>() : Error{"the rasteriser refuses a shader: " + message};
}

namespace {

// Goes through the samples as they lie in memory. Their number is known when this is compiled: films wait for it.
template <int kSamples, class Channel>
ImageOf<Channel> averaged_of(const std::vector<Channel>& rgba, int width, int height) {
  using Sum = std::conditional_t<sizeof(Channel) == 1, std::uint16_t, std::uint32_t>;
  ImageOf<Channel> image(width, height);
  const auto columns = static_cast<std::size_t>(width);
  std::vector<Sum> sums(columns * 3);
  const Channel* in = rgba.data();
  for (int y = height - 1; y >= 0; --y) {
    std::fill(sums.begin(), sums.end(), Sum{0});
    for (int row = 0; row < kSamples; ++row) {
      Sum* sum = sums.data();
      for (std::size_t x = 0; x < columns; ++x, sum += 3) {
        for (int sample = 0; sample < kSamples; ++sample, in += 4) {
          for (int c = 0; c < 3; ++c) sum[c] = static_cast<Sum>(sum[c] + in[c]);
        }
      }
    }
    constexpr int kAll = kSamples * kSamples;
    std::transform(sums.begin(), sums.end(), image.pixel(0, y),
                   [](Sum sum) { return static_cast<Channel>((sum + kAll / 2) / kAll); });
  }
  return image;
}

}  // namespace

template <class Channel>
ImageOf<Channel> averaged(const std::vector<Channel>& rgba, int width, int height, int samples) {
  return samples == 1   ? averaged_of<1>(rgba, width, height)
         : samples == 2 ? averaged_of<2>(rgba, width, height)
                        : averaged_of<3>(rgba, width, height);
}
template Image averaged(const std::vector<std::uint8_t>& rgba, int width, int height, int samples);
template DeepImage averaged(const std::vector<std::uint16_t>& rgba, int width, int height, int samples);

}  // namespace shaken::render
