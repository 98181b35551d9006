"""Bindings of materials."""


class Material:
    """A material."""

    def __init__(self, prim):
        self.prim = prim

    def __bool__(self):
        return self.prim is not None

    def GetPrim(self):
        return self.prim

    def GetPath(self):
        return self.prim.GetPath()


class MaterialBindingAPI:
    """The material of a prim."""

    def __init__(self, prim):
        self.prim = prim

    def ComputeBoundMaterial(self):
        for relation in self.prim.GetRelationships():
            if relation.GetName() == "material:binding":
                return Material(self.prim.stage.GetPrimAtPath(relation.GetForwardedTargets()[0])), relation
        return Material(None), None
