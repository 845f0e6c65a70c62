#pragma once
#include <string>

#include "gl/functions.h"

namespace lumi {

/// A linked pair of shaders. Throws Error(BadInput) with the compiler's own text when GLSL does not compile.
class Program {
public:
    Program(const GlFunctions& gl, const std::string& name, const std::string& vertex, const std::string& fragment);
    ~Program();
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;

    void use() const { gl_.UseProgram(id_); }
    /// Setters act on the program in use; a uniform that the compiler removed is ignored.
    void set(const char* uniform, int value) const { gl_.Uniform1i(location(uniform), value); }
    void set(const char* uniform, float value) const { gl_.Uniform1f(location(uniform), value); }
    void set(const char* uniform, float x, float y) const { gl_.Uniform2f(location(uniform), x, y); }
    void set(const char* uniform, float x, float y, float z, float w) const {
        gl_.Uniform4f(location(uniform), x, y, z, w);
    }

private:
    GLint location(const char* uniform) const { return gl_.GetUniformLocation(id_, uniform); }

    const GlFunctions& gl_;
    GLuint id_ = 0;
};

}  // namespace lumi
