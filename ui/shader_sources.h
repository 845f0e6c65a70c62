#pragma once

namespace lumi {

// The files of shaders/, compiled into the program.
extern const char* const kViewVertexShader;
extern const char* const kViewFragmentShader;
extern const char* const kUiVertexShader;
extern const char* const kUiFragmentShader;

}  // namespace lumi
