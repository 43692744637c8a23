/** Portuguese names of what the warnings of a measurement are about. */
export const aspects: Record<string, string> = {
  blur: 'borrão', sample: 'amostra', view: 'campo de visão', alignment: 'alinhamento', aperture: 'abertura', arc: 'arco', axis: 'eixo', coding: 'codificação', contrast: 'contraste', controller: 'controlador', coverage: 'cobertura', crowding: 'aglomeração', detection: 'detecção', displacement: 'deslocamento',
  drag: 'arrasto', drift: 'deriva', edge: 'borda', edges: 'bordas', exchanged: 'trocadas', failed: 'falhas', field: 'campo', field_strength: 'intensidade do campo', focus: 'foco', frame_rate: 'taxa de quadros', 'frame rate': 'taxa de quadros', gain: 'ganho', light: 'luz',
  linearity: 'linearidade', linking: 'ligação', marks: 'marcas', method: 'método', motile_fraction: 'fração móvel', noise: 'ruído', outline: 'contorno', polarity: 'polaridade', populations: 'populações', radius: 'raio', range: 'intervalo', readings: 'leituras',
  residual: 'resíduo', response: 'resposta', responsive_fraction: 'fração responsiva', reversal: 'inversão', saturation: 'saturação', scale: 'escala', search: 'busca', shape: 'forma', signal: 'sinal', size: 'tamanho', small: 'pequeno', speed_spread: 'dispersão da velocidade',
  texture: 'textura', threshold: 'limiar', tilt: 'inclinação', timing: 'instantes', turning: 'giro', units: 'unidades', motion: 'movimento', background: 'fundo', fit: 'ajuste', flow: 'fluxo', identifiability: 'identificabilidade',
};
