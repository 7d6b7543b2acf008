"""What can go wrong, by kind."""


class StromboliError(Exception):
    """Any error of Stromboli. Its text is one line: where, what is wrong, what was expected."""


class UsageError(StromboliError, ValueError):
    """What is asked for makes no sense."""


class SceneError(StromboliError):
    """The scene cannot be read or makes no sense."""


class DeviceError(StromboliError):
    """There is no usable Vulkan device, or it fails."""


class DeviceLostError(DeviceError):
    """The device stopped working; another try may succeed."""


class OutputError(StromboliError, OSError):
    """A file cannot be written."""
