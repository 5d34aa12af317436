#pragma once

// OSMesa exports the functions of OpenGL itself; their declarations come with this macro.
#define GL_GLEXT_PROTOTYPES
#include <GL/gl.h>
#include <GL/glext.h>
