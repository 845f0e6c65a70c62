#version 330 core
uniform sampler2D uTexture;
in vec2 vTexture;
in vec4 vColour;
out vec4 oColour;

void main() { oColour = vColour * texture(uTexture, vTexture); }
