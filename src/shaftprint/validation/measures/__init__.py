"""What a model makes of a record is compared with it by: misfit beyond noise, remaining delay, numbers of a step."""
