"""Draws the image of a viewport by Blender's module `gpu`."""


class Drawing:
    """The last image as a texture; `gpu` and `draw_texture` are Blender's gpu and
    gpu_extras.presets.draw_texture_2d."""

    def __init__(self, gpu, draw_texture):
        self.gpu = gpu
        self.draw_texture = draw_texture
        self.pixels = None  # of the texture
        self.texture = None

    def draw(self, engine, scene, pixels, width, height):
        """Fills a region of this size with the pixels, of (height, width, 4); nothing where they are None."""
        if pixels is None:
            return
        if pixels is not self.pixels:
            rows, columns = pixels.shape[:2]
            data = self.gpu.types.Buffer("FLOAT", pixels.size, pixels.reshape(-1))
            self.texture = self.gpu.types.GPUTexture((columns, rows), format="RGBA16F", data=data)
            self.pixels = pixels
        self.gpu.state.blend_set("ALPHA_PREMULT")
        engine.bind_display_space_shader(scene)
        try:
            self.draw_texture(self.texture, (0, 0), width, height)
        finally:
            engine.unbind_display_space_shader()
            self.gpu.state.blend_set("NONE")
