#include "render/gl_context.h"

#include "render/gl.h"
//
#include <GL/osmesa.h>

#include <cstdlib>
#include <future>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

namespace shaken::render {

void GlContext::Deleter::operator()(void* context) const { OSMesaDestroyContext(static_cast<OSMesaContext>(context)); }

GlContext::GlContext(GlContext&&) noexcept = default;
GlContext& GlContext::operator=(GlContext&&) noexcept = default;
GlContext::~GlContext() = default;

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

}  // namespace

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

}  // namespace shaken::render
