#version 330 core
uniform vec2 uPixelScale;  // 2 / framebuffer size
layout(location = 0) in vec2 iPosition;
layout(location = 1) in vec2 iTexture;
layout(location = 2) in vec4 iColour;
out vec2 vTexture;
out vec4 vColour;

void main() {
    vTexture = iTexture;
    vColour = iColour;
    gl_Position = vec4(iPosition.x * uPixelScale.x - 1.0, 1.0 - iPosition.y * uPixelScale.y, 0.0, 1.0);
}
