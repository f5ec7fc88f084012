"""The fit problem of one structure and one response."""

from shaftprint.identify.likelihood._build_objective import build_joint_objective


def build_objective(structure, response, **known):
    return build_joint_objective([(structure, response)], **known)
