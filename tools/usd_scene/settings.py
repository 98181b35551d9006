"""From UsdRender.Settings: the image, and how it fits the camera's aperture."""
from . import values


class Settings:
    """The render settings of a stage, or defaults without any (None)."""

    def __init__(self, prim, resolution=None):
        self.camera = None if prim is None else values.target(prim, "camera")
        size = None if prim is None else values.value(prim, "resolution", None)
        self.width, self.height = resolution or ((960, 540) if size is None else (int(size[0]), int(size[1])))
        self.pixel_aspect = self._value(prim, "pixelAspectRatio", 1.0)
        # Without settings the image is as wide as the aperture.
        self.policy = self._value(prim, "aspectRatioConformPolicy",
                                  "adjustApertureHeight" if prim is None else "expandAperture")
        still = self._value(prim, "instantaneousShutter", False) or self._value(prim, "disableMotionBlur", False)
        self.motion_blur = not still
        self.depth_of_field = not self._value(prim, "disableDepthOfField", False)

    @staticmethod
    def _value(prim, name, default):
        return default if prim is None else values.value(prim, name, None, default)

    def fit(self, aperture_width, aperture_height):
        """(width, height) of the part of the film that the image shows."""
        shape = self.width * self.pixel_aspect / self.height
        fitting = {"adjustApertureHeight": aperture_width, "adjustApertureWidth": aperture_height * shape,
                   "expandAperture": max(aperture_width, aperture_height * shape),
                   "cropAperture": min(aperture_width, aperture_height * shape)}
        if self.policy == "adjustPixelAspectRatio":
            self.pixel_aspect = aperture_width / aperture_height * self.height / self.width
            return aperture_width, aperture_height
        width = fitting.get(self.policy, fitting["expandAperture"])
        return width, width / shape

    def image_keys(self):
        """Keys of [image]."""
        keys = {"width": self.width, "height": self.height}
        return keys if self.pixel_aspect == 1 else {**keys, "pixel_aspect": float(self.pixel_aspect)}
