function [model, response, omega] = @NAME@(omega)
%@NAME_UPPER@  @TITLE@
%
%   model = @NAME@() reads @DATA_WORDS@, which stands beside this file, and rebuilds what the program at hand has classes for:
%     model.sys      ss object with its delays, exact (Control System Toolbox of MATLAB)
%     model.frd      frd object of the response (Control System Toolbox of MATLAB, package control of Octave)
%     model.idfrd    idfrd object of the response with its covariance (System Identification Toolbox)
%   and, where the file holds what was measured, model.measured.frd and model.measured.idfrd of that;
%   each is empty where there is no such class. The numbers that they are made of stand beside them. An output whose
%   time stamps lie ahead of what can be known comes late in model.sys, by model.sys_lateness_s.
%
%   [model, response, omega] = @NAME@(omega) returns the response of the linear model at omega [rad/s] too: outputs
%   times inputs times frequencies, with exact delays, by plain functions that need no toolbox. Without omega it is
%   given at the frequencies that are stored.
%
%   @NAME@(...) without anything to return to draws the response.
%
%   Inputs and outputs are deviations over the working point; model.inputs and model.outputs have names, units and
%   what a deviation of 1 stands for. Written by shaftprint @VERSION@.

  folder = fileparts(mfilename('fullpath'));
  stored = load(fullfile(folder, @DATA@));
  model = stored.shaftprint;
  model.title = native2unicode(model.title_utf8(:)', 'UTF-8');
  if nargin < 1
    omega = model.response.omega_rad_s;
  end
  omega = omega(:);
  response = response_of(model.linear, omega);
  model.sys = rebuilt_system(model);
  model.sys_lateness_s = max(-model.linear.output_delay_s(:), 0);
  model.frd = rebuilt_frd(model.response);
  model.idfrd = rebuilt_idfrd(model.response);
  if isfield(model, 'measured')
    model.measured.frd = rebuilt_frd(model.measured);
    model.measured.idfrd = rebuilt_idfrd(model.measured);
  end
  if nargout == 0
    draw(model, response, omega);
    clear model
  end
end

function response = response_of(linear, omega)
% Close the delays around the system without delays at each frequency.
  into = linear.count_inputs;
  out = linear.count_outputs;
  states = size(linear.A, 1);
  delays = numel(linear.tau_s);
  response = zeros(out, into, numel(omega));
  for k = 1:numel(omega)
    s = 1i * omega(k);
    H = linear.D;
    if states > 0
      H = H + linear.C * ((s * eye(states) - linear.A) \ linear.B);
    end
    found = H(1:out, 1:into);
    if delays > 0
      late = diag(exp(-s * linear.tau_s(:)));
      loop = eye(delays) - late * H(out+1:end, into+1:end);
      found = found + H(1:out, into+1:end) * (loop \ (late * H(out+1:end, 1:into)));
    end
    response(:, :, k) = diag(exp(-s * linear.output_delay_s(:))) * found;
  end
end

function sys = rebuilt_system(model)
% Return the state space with its delays, nothing where there is no class that has them.
  linear = model.linear;
  sys = rebuilt('ss', @() ss(linear.A, linear.B, linear.C, linear.D));
  if isempty(sys)
    return
  end
  try
    if ~isempty(linear.tau_s)
      sys = setDelayModel(sys, linear.tau_s(:));
    end
    sys.InputName = model.inputs.names(:);
    sys.OutputName = model.outputs.names(:);
    sys.OutputDelay = max(linear.output_delay_s(:), 0);
  catch problem
    warning('shaftprint:rebuild', 'no state space with these delays can be made here: %s', problem.message);
    sys = [];
  end
end

function object = rebuilt_frd(data)
% Return a response as an object of its class.
  object = rebuilt('frd', @() frd(data.H, data.omega_rad_s));
end

function object = rebuilt_idfrd(data)
% Return a response with its covariance as an object of its class.
  object = rebuilt('idfrd', @() idfrd(data.H, data.omega_rad_s, 0, 'CovarianceData', data.covariance));
end

function object = rebuilt(name, make)
% Return an object of a class, nothing where there is no such class here.
  object = [];
  if ~isempty(which(name))
    try
      object = make();
    catch problem
      warning('shaftprint:rebuild', '%s cannot be rebuilt: %s', name, problem.message);
    end
  end
end

function draw(model, response, omega)
% Draw magnitude and phase of every output.
  outputs = numel(model.outputs.names);
  inputs = numel(model.inputs.names);
  for row = 1:outputs
    for column = 1:inputs
      value = squeeze(response(row, column, :));
      place = (row - 1) * inputs + column;
      subplot(2, outputs * inputs, place);
      semilogx(omega, 20 * log10(abs(value)));
      title(sprintf('%s / %s', model.outputs.names{row}, model.inputs.names{column}), 'Interpreter', 'none');
      ylabel('magnitude [dB]');
      subplot(2, outputs * inputs, outputs * inputs + place);
      semilogx(omega, unwrap(angle(value)) * 180 / pi);
      xlabel('omega [rad/s]');
      ylabel('phase [deg]');
    end
  end
end
