#include "render/gl.h"

//
#include <GL/osmesa.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <future>
#include <string>
#include <system_error>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

namespace shaken::render {
namespace {

/// The one rasteriser that is tested: what the environment chooses for other programs (WSL sets GALLIUM_DRIVER) ends
/// this one by a signal, or draws other pixels.
void choose_rasteriser() {
  for (const char* name : {"MESA_GL_VERSION_OVERRIDE", "MESA_GLSL_VERSION_OVERRIDE", "MESA_EXTENSION_OVERRIDE",
                           "MESA_LOADER_DRIVER_OVERRIDE", "LIBGL_ALWAYS_SOFTWARE", "MESA_NO_ERROR"}) {
    unsetenv(name);
  }
  setenv("GALLIUM_DRIVER", "llvmpipe", 1);
  // Mesa would keep compiled shaders in the home directory; compiling them takes a tenth of a second
  setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);
}

/// Mesa waits for ever for a thread of its own that the system has refused: whether there are as many.
Result<void> ask_for_threads() {
  std::vector<std::thread> threads;
  std::promise<void> release;
  const std::shared_future<void> released = release.get_future().share();
  Result<void> done;
  try {
    for (int n = static_cast<int>(std::thread::hardware_concurrency()) + 2; n > 0; --n)
      threads.emplace_back([released] { released.wait(); });
  } catch (const std::system_error& problem) {
    done = Error{std::string("the system has no threads to draw with: ") + problem.what(), problem.code().value()};
  }
  release.set_value();
  for (std::thread& thread : threads) thread.join();
  return done;
}

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

void GlContext::Deleter::operator()(void* context) const { OSMesaDestroyContext(static_cast<OSMesaContext>(context)); }

Result<GlContext> GlContext::create() {
  [[maybe_unused]] static const bool once = (choose_rasteriser(), true);
  SHAKEN_TRY(ask_for_threads());
  const int attributes[] = {OSMESA_FORMAT,
                            OSMESA_RGBA,
                            OSMESA_DEPTH_BITS,
                            24,
                            OSMESA_PROFILE,
                            OSMESA_CORE_PROFILE,
                            OSMESA_CONTEXT_MAJOR_VERSION,
                            3,
                            OSMESA_CONTEXT_MINOR_VERSION,
                            3,
                            0};
  void* context = OSMesaCreateContextAttribs(attributes, nullptr);
  if (!context)
    return Error{"cannot make an OpenGL 3.3 context: is OSMesa (libosmesa6) of Mesa 22 or later installed?"};
  return GlContext(context);
}

template <class Channel>
Result<void> GlContext::bind(int width, int height) {
  auto& pixels = std::get<std::vector<Channel>>(pixels_);
  pixels.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4);
  constexpr GLenum kType = sizeof(Channel) == 1 ? GL_UNSIGNED_BYTE : GL_UNSIGNED_SHORT;
  if (!OSMesaMakeCurrent(static_cast<OSMesaContext>(context_.get()), pixels.data(), kType, width, height)) {
    return Error{"OSMesa refuses a frame buffer of " + std::to_string(width) + " x " + std::to_string(height) +
                 " pixels"};
  }
  glViewport(0, 0, width, height);
  return {};
}
template Result<void> GlContext::bind<std::uint8_t>(int width, int height);
template Result<void> GlContext::bind<std::uint16_t>(int width, int height);

template <class Channel>
const std::vector<Channel>& GlContext::finished_pixels() {
  glFinish();
  return std::get<std::vector<Channel>>(pixels_);
}
template const std::vector<std::uint8_t>& GlContext::finished_pixels();
template const std::vector<std::uint16_t>& GlContext::finished_pixels();

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

template <class Channel>
ImageOf<Channel> averaged(const std::vector<Channel>& rgba, int width, int height, int samples) {
  return samples == 1   ? averaged_of<1>(rgba, width, height)
         : samples == 2 ? averaged_of<2>(rgba, width, height)
                        : averaged_of<3>(rgba, width, height);
}
template Image averaged(const std::vector<std::uint8_t>& rgba, int width, int height, int samples);
template DeepImage averaged(const std::vector<std::uint16_t>& rgba, int width, int height, int samples);

}  // namespace shaken::render
