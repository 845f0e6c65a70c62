#include "gl/program.h"

#include "base/error.h"

namespace lumi {

namespace {

GLuint compile(const GlFunctions& gl, GLenum stage, const std::string& name, const std::string& source) {
    const GLuint shader = gl.CreateShader(stage);
    const char* text = source.c_str();
    gl.ShaderSource(shader, 1, &text, nullptr);
    gl.CompileShader(shader);
    GLint good = GL_FALSE;
    gl.GetShaderiv(shader, GL_COMPILE_STATUS, &good);
    if (good) return shader;
    std::string log(4096, '\0');
    GLsizei length = 0;
    gl.GetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), &length, log.data());
    log.resize(static_cast<size_t>(length));
    gl.DeleteShader(shader);
    throwBadInput({.what = "shader does not compile: " + log,
                   .where = name + (stage == GL_VERTEX_SHADER ? ".vert" : ".frag"),
                   .expected = "",
                   .found = ""});
}

}  // namespace

Program::Program(const GlFunctions& gl, const std::string& name, const std::string& vertex, const std::string& fragment)
    : gl_(gl) {
    const GLuint vertexShader = compile(gl, GL_VERTEX_SHADER, name, vertex);
    GLuint fragmentShader = 0;
    try {
        fragmentShader = compile(gl, GL_FRAGMENT_SHADER, name, fragment);
    } catch (...) {
        gl.DeleteShader(vertexShader);
        throw;
    }
    id_ = gl.CreateProgram();
    gl.AttachShader(id_, vertexShader);
    gl.AttachShader(id_, fragmentShader);
    gl.LinkProgram(id_);
    gl.DeleteShader(vertexShader);
    gl.DeleteShader(fragmentShader);
    GLint good = GL_FALSE;
    gl.GetProgramiv(id_, GL_LINK_STATUS, &good);
    if (good) return;
    std::string log(4096, '\0');
    GLsizei length = 0;
    gl.GetProgramInfoLog(id_, static_cast<GLsizei>(log.size()), &length, log.data());
    log.resize(static_cast<size_t>(length));
    gl.DeleteProgram(id_);
    throwBadInput({.what = "shaders do not link: " + log, .where = name, .expected = "", .found = ""});
}

Program::~Program() { gl_.DeleteProgram(id_); }

}  // namespace lumi
