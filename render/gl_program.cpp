#include "render/gl_program.h"

#include <algorithm>
#include <array>
#include <type_traits>
#include <utility>

namespace shaken::render {

ProgramVariants::ProgramVariants(ShaderText vertex, ShaderText fragment) {
  for (const char* piece : vertex) vertex_ += piece;
  for (const char* piece : fragment) fragment_ += piece;
}

Result<GLuint> ProgramVariants::with(const std::string& defines) {
  if (const auto made = made_.find(defines); made != made_.end()) return made->second;
  std::string fragment = fragment_;
  fragment.insert(fragment.find('\n') + 1, defines);
  const GLuint program = glCreateProgram();
  for (const auto& [kind, text] :
       {std::pair{GL_VERTEX_SHADER, vertex_.c_str()}, std::pair{GL_FRAGMENT_SHADER, fragment.c_str()}}) {
    const GLuint shader = glCreateShader(static_cast<GLenum>(kind));
    glShaderSource(shader, 1, &text, nullptr);
    glCompileShader(shader);
    glAttachShader(program, shader);
    glDeleteShader(shader);
  }
  glLinkProgram(program);
  GLint linked = GL_FALSE;
  glGetProgramiv(program, GL_LINK_STATUS, &linked);
  if (linked) return made_[defines] = program;
  std::array<char, 2048> text{};
  glGetProgramInfoLog(program, static_cast<GLsizei>(text.size()), nullptr, text.data());
  glDeleteProgram(program);
  return Error{std::string("the rasteriser refuses a shader: ") + text.data()};
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
